// The estimators of stage 2 as rows of a table. To add one: a file in estimators/ and one line in
// estimators.cpp.
#pragma once

#include <span>
#include <string_view>

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// A row of the table (`cablefit list estimators`).
struct Estimator {
  std::string_view name;
  std::string_view description;
  std::string_view source;
  Estimation (*estimate)(const EstimationTask& task);
  bool by_filtered_rows = true;  ///< filter, differences and rounding bias it (method_floor.hpp)
};

std::span<const Estimator> estimators();
/// Throws Error(usage) with a suggestion.
const Estimator& find_estimator(std::string_view name);

}  // namespace cablefit
