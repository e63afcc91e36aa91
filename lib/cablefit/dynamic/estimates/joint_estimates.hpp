// The parameters of both equations and of stage 1 as estimates with a joint covariance.
#pragma once

#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/estimate/fit/derived_quantity.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// Contribution of each stretch of time to the estimates of one equation, and their sensitivity to
/// errors of stage 1.
struct EquationInfluence {
  std::vector<std::string> names;   ///< of the columns of `influence`
  std::vector<Eigen::Index> cells;  ///< numbers of the stretches, ascending
  Eigen::Index cell_rows = 0;       ///< length of a stretch
  Eigen::MatrixXd influence;        ///< cells x parameters
  Eigen::MatrixXd sensitivity;      ///< parameters x elastic coefficients, d x / d coefficient
  double degrees_of_freedom = 1;
};

/// For the solution of one equation's rows. `stage1` and `which`: see add_estimates().
EquationInfluence influence_of(const RowStatistics& rows, const DynamicColumns& columns,
                               const LinearSolution& solution, const ElasticFit* stage1,
                               std::size_t which);

/// The elastic coefficients of stage 1, and the fit's parameters that have an sd and are not at a
/// bound. Variances are those of the fit. Residuals of equations at the same time may be correlated
/// (HAC over the stretches), and both equations share the errors of stage 1 (Murphy & Topel 1985).
/// Otherwise equations with different stretches count as uncorrelated.
JointEstimates join_estimates(const DynamicFit& fit, const std::vector<EquationInfluence>& parts,
                              const ElasticFit* stage1);

/// The quantities f_0, zeta and f_dry, besides those of elastic_quantities(). f_0 = sqrt(K
/// (1/J_motor + 1/J_link)) / 2 pi with K = K_rest (Fichera & Grossard 2017, (14) without friction).
/// zeta is the damping ratio of that mode (Meirovitch 2001, 7.7: f_v and f_vm projected on its
/// shape). f_dry = f_s + f_sm is the torque that turns motor and link from rest. A quantity is left
/// out when one of its parameters is not known. None with several joints.
std::vector<Estimate> drive_quantities(const JointEstimates& from, const Transmission* transmission,
                                       bool cable_space, Axes axes);

}  // namespace cablefit
