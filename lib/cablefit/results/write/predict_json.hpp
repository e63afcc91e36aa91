// cablefit/predict/1: predictions along logs as a file, see data/schema/predict.schema.json.
#pragma once

#include <string>

#include "cablefit/predict/predict_result.hpp"

namespace cablefit {

std::string predict_json(const PredictResult& result);

}  // namespace cablefit
