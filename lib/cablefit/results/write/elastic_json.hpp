// cablefit/elastic/1: the result of stage 1 as a file, see data/schema/elastic.schema.json.
#pragma once

#include <string>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

std::string elastic_json(const ElasticResult& result);

}  // namespace cablefit
