// Predictions of a model along logs as a report: elastic quantities, torques beside the sensors',
// contacts.
#pragma once

#include "cablefit/predict/predict_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

Document predict_document(const PredictResult& result);

}  // namespace cablefit
