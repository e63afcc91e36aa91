// Recursive least squares: the weighted fit, row after row, with its trace.
#include <array>

#include "cablefit/dynamic/estimators/online_traces.hpp"
#include "cablefit/dynamic/estimators/rows.hpp"

namespace cablefit::estimation {
namespace {

Estimation estimate_recursively(const EstimationTask& task) {
  constexpr std::array methods = {OnlineMethod::recursive};
  return with_traces(task, methods);
}

}  // namespace

Estimator recursive() {
  return {"recursive",
          "R-LSA: the weighted fit row after row, with its trace in a CSV file; --memory forgets",
          "Bierman 1977, ch. V; Ljung & Soderstrom 1983, 2.6", estimate_recursively};
}

}  // namespace cablefit::estimation
