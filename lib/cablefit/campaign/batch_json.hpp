// cablefit/batch/1: a campaign's results as a file, see data/schema/batch.schema.json.
#pragma once

#include <string>

#include "cablefit/campaign/batch.hpp"

namespace cablefit {

std::string batch_json(const BatchResult& result);

}  // namespace cablefit
