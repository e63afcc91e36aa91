// Is a model's residual white, and does it depend on any variable? Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/checks/judged_rows.hpp"
#include "cablefit/dynamic/validation_result.hpp"

namespace cablefit {

/// The tested rows, and the scale of their torque.
struct TestedRows {
  const JudgedRows& rows;
  bool fitted = false;      ///< the rows are those of the fit
  double row_seconds = 0;   ///< between rows
  double torque_rms = 0;    ///< of the torque to be explained, N m; 1 % of it is material
  std::string torque_unit;  ///< "N m"
};

/// Whiteness first, then every tested variable that varies. `solution` is of the rows' equation;
/// its relative error and headline are filled in.
std::vector<ResidualTest> residual_tests(const TestedRows& tested, const LinearSolution& solution,
                                         JudgedEquation& equation);

/// About `most` values of a column, evenly spread over the rows.
std::vector<double> sampled_column(const JudgedRows& rows, Eigen::Index column, std::size_t most);

}  // namespace cablefit
