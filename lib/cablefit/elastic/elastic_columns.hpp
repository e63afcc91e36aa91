// The blocked-link equation as columns: elastic basis of every cable, drive offset, friction branch
// and torque. Which of them form a model is decided when solving.
#pragma once

#include <Eigen/Core>

#include "cablefit/model/cables.hpp"
#include "cablefit/samples/row_stream.hpp"

namespace cablefit {

/// Elastic torque per unit coefficient, motor side S_jc basis(l_c) or link side P_jc basis(l_c),
/// for every coefficient of every cable of order `order`, side by side. `out`: rows x coefficients.
enum class ElasticSide { motor, link };
void elastic_basis(const Transmission& transmission, const JointSignals& signals, ElasticSide side,
                   Eigen::Ref<Eigen::MatrixXd> out);

/// Number of columns elastic_basis writes.
Eigen::Index n_elastic_columns(const Transmission& transmission);

/// Position of every column of the blocked equation.
struct BlockedColumns {
  Eigen::Index deflection = 0;  ///< phi = theta - theta_0 - q
  Eigen::Index basis = 1;       ///< first of n_basis columns
  Eigen::Index n_basis = 0;
  Eigen::Index offset = 0, direction = 0, speed = 0, zero = 0, tau = 0;
  Eigen::Index count = 0;
};
BlockedColumns blocked_columns(const Transmission& transmission);

/// tau = tau_elas_m(theta - theta_0 - q) + offset + f_sm * direction + f_vm * thetad, with
/// direction -1 or 1 of the last motion. `pilot` (may be null): a first curve, whose -d tau/d
/// theta_0 is column `zero`. `sliding`: rows in motion only, else rows at rest only (plateaus).
/// `still_speed` > 0: only rows in which the link is slower than this (--still).
Equation blocked_equation(const Transmission& transmission, const Transmission* pilot, bool sliding,
                          double rest_speed, double still_speed);

}  // namespace cablefit
