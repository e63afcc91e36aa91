// The gradient estimator (normalised LMS), beside the recursive one and the direct answer.
#include <array>

#include "cablefit/dynamic/estimators/online_traces.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"

namespace cablefit::estimation {
namespace {

Estimation estimate_by_gradient(const EstimationTask& task) {
  constexpr std::array methods = {OnlineMethod::recursive, OnlineMethod::gradient};
  return with_traces(task, methods);
}

}  // namespace

Estimator gradient() {
  return {"gradient", "normalised LMS row after row, its trace beside the recursive one and wls",
          "Haykin 2002, ch. 6; Ljung & Soderstrom 1983, 3.6", estimate_by_gradient};
}

}  // namespace cablefit::estimation
