// The blocked-link equation as columns: elastic basis of every cable, drive offset, friction branch
// and torque. Which of them form a model is decided when solving.
#pragma once

#include <Eigen/Core>
#include <span>

#include "cablefit/model/cables.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// Elastic torque per unit coefficient, motor side S_jc basis(l_c) or link side P_jc basis(l_c),
/// for every coefficient of every cable of order `order`, side by side. `out`: rows x coefficients.
enum class ElasticSide { motor, link };
/// Of joint `joint` (from 0) of several, whose motion all cables that pass it depend on.
void elastic_basis(const Transmission& transmission, std::span<const JointSignals> joints,
                   ElasticSide side, int joint, Eigen::Ref<Eigen::MatrixXd> out);
/// Of a rig of one joint. `others`: what else stretches each cable, rows x cables, m; no columns:
/// nothing.
void elastic_basis(const Transmission& transmission, const JointSignals& signals, ElasticSide side,
                   Eigen::Ref<Eigen::MatrixXd> out, const Eigen::ArrayXXd& others = {});

/// Elongation of one cable (m, joint space rad), row by row; `joints`: of all joints of the rig.
Eigen::ArrayXd elongation(const Transmission& transmission, const Cable& cable,
                          std::span<const JointSignals> joints);

/// Column of S or P of one cable at joint `own` (from 0), m, row by row.
Eigen::ArrayXd levers(const Transmission& transmission, const Cable& cable,
                      std::span<const JointSignals> joints, MapSide side, std::size_t own);

/// Number of columns elastic_basis writes.
Eigen::Index n_elastic_columns(const Transmission& transmission);

/// Position of every column of the blocked equation. With n joints, the equations of all have the
/// same columns, so that their rows can stand under each other: of deflection, offset, direction,
/// speed and zero there is one per joint, side by side, and 0 in the rows of the other joints, but
/// for the zeros, which stretch the cables of other joints too; each cable's coefficients are
/// shared. The elongation of every cable follows tau.
struct BlockedColumns {
  int n_joints = 1;
  Eigen::Index deflection = 0;  ///< phi = theta - theta_0 - N q, Transmission::deflections
  Eigen::Index basis = 1;       ///< first of n_basis columns
  Eigen::Index n_basis = 0;
  Eigen::Index offset = 0, direction = 0, speed = 0, zero = 0, tau = 0;
  Eigen::Index elongation = 0;  ///< first of one per cable
  Eigen::Index count = 0;

  /// The same with deflection, offset, direction, speed and zero those of one joint (from 0).
  BlockedColumns of_joint(int joint) const;
};
BlockedColumns blocked_columns(const Transmission& transmission);

/// tau = tau_elas_m(theta - theta_0, q) + offset + f_sm * direction + f_vm * thetad, with
/// direction -1 or 1 of the last motion. `preliminary` (may be null): a first curve, whose d tau/d
/// theta_0 are the columns from `zero` on, of the motors of all joints. `sliding`: rows in motion
/// only, else rows at rest only (plateaus). `still_speed` > 0: only rows in which the link is
/// slower than this (--still). `joint`: whose equation, from 0.
Equation blocked_equation(const Transmission& transmission, const Transmission* preliminary,
                          bool sliding, double rest_speed, double still_speed, int joint = 0);

}  // namespace cablefit
