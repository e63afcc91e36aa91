// Is what a model leaves white, and does it depend on anything? Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/checks/judged_rows.hpp"
#include "cablefit/dynamic/validation_result.hpp"

namespace cablefit {

/// Which rows are tested, and how large things are there.
struct TestedRows {
  const JudgedRows& rows;
  bool fitted = false;      ///< the rows are those of the fit
  double row_seconds = 0;   ///< between rows
  double torque_rms = 0;    ///< of what is to be explained, N m: 1 % of it is material
  std::string torque_unit;  ///< "N m"
};

/// Whiteness, then every tested variable that moves. `solution` is of the rows' equation, whose
/// relative error and headline are filled in.
std::vector<ResidualTest> residual_tests(const TestedRows& tested, const LinearSolution& solution,
                                         JudgedEquation& equation);

/// About `most` values of a column, evenly spread over the rows.
std::vector<double> sampled_column(const JudgedRows& rows, Eigen::Index column, std::size_t most);

}  // namespace cablefit
