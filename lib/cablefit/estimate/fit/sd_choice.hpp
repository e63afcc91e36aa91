// The standard deviation that is reported, chosen among white, HAC and block bootstrap by a rule.
#pragma once

#include <vector>

#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

enum class SdKind { white, hac, block_bootstrap };

struct ChosenSd {
  std::vector<SdKind> kind;            ///< per parameter
  Eigen::VectorXd variance;            ///< per parameter
  Eigen::VectorXd degrees_of_freedom;  ///< per parameter, for t quantiles
  double effective_rows = 0;           ///< of the parameter that has the fewest
  Eigen::Index blocks = 0;             ///< of the bootstrap, when it was needed

  SdKind worst() const;
};

/// Per parameter: white when the HAC variance, which is never below sigma^2 (W'W)^-1, is above it
/// by no more than it scatters itself (2 sd, at least 10 %); HAC as long as at least 100 rows count
/// as independent; else the noise is too slow for a kernel, whose prewhitening ends at a
/// correlation of 0.97 a cell, and the block bootstrap of the cells' influences with blocks of five
/// correlation lengths takes its place (never below HAC).
ChosenSd choose_sd(const RowStatistics& rows, const LinearSolution& solution);

}  // namespace cablefit
