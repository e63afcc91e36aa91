// The parameters of both equations and of stage 1 as estimates that are known together.
#pragma once

#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/estimate/fit/derived_quantity.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// What every stretch of time adds to the estimates of one equation, and what an error of stage 1
/// does to them.
struct EquationInfluence {
  std::vector<std::string> names;   ///< of the columns of `influence`
  std::vector<Eigen::Index> cells;  ///< numbers of the stretches, ascending
  Eigen::Index cell_rows = 0;       ///< length of a stretch
  Eigen::MatrixXd influence;        ///< cells x parameters
  Eigen::MatrixXd sensitivity;      ///< parameters x elastic coefficients, d x / d coefficient
  double degrees_of_freedom = 1;
};

/// Of the solution for one equation's rows. `stage1` and `which`: see add_estimates().
EquationInfluence influence_of(const RowStatistics& rows, const DynamicColumns& columns,
                               const LinearSolution& solution, const ElasticFit* stage1,
                               std::size_t which);

/// The elastic coefficients of stage 1, and the fit's parameters that have an sd and stand on no
/// bound. Variances are those of the fit; residuals of equations at the same time are correlated as
/// they are (HAC over the stretches), and both equations share the errors of stage 1 (Murphy &
/// Topel 1985). Equations whose stretches differ are taken as uncorrelated beside that.
JointEstimates join_estimates(const DynamicFit& fit, const std::vector<EquationInfluence>& parts,
                              const ElasticFit* stage1);

/// f_0 = sqrt(K (1/J_motor + 1/J_link)) / 2 pi with K = K_rest (Fichera & Grossard 2017, (14)
/// without friction), zeta, the damping ratio of that mode (Meirovitch 2001, 7.7: f_v and f_vm
/// projected on its shape), and f_dry = f_s + f_sm, what turns motor and link from rest; beside
/// those of elastic_quantities(). Only what all its parameters are known for; nothing of several
/// joints.
std::vector<Estimate> drive_quantities(const JointEstimates& from, const Transmission* transmission,
                                       bool cable_space, bool linear_motion);

}  // namespace cablefit
