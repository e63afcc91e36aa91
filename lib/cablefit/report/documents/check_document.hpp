// What `cablefit check` found, as a report.
#pragma once

#include "cablefit/dynamic/prediction.hpp"
#include "cablefit/report/parts/document.hpp"
#include "cablefit/samples/check.hpp"

namespace cablefit {

Document check_document(const CheckResult& result, const std::vector<Prediction>& predictions = {});

}  // namespace cablefit
