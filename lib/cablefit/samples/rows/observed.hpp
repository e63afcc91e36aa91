// More columns for an equation, that no fit uses: what residuals are plotted against.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

struct Observed {
  std::string name, unit;
  /// n rows; an empty array where a log has no such signal, which becomes NaN.
  std::function<Eigen::ArrayXd(const Signals&)> value;
};

/// The equation with one column more for each of `observed`, behind its own; which rows come out
/// does not change.
Equation with_observed(const Equation& equation, const std::vector<Observed>& observed);

}  // namespace cablefit
