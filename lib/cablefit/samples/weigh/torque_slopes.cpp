#include "cablefit/samples/weigh/torque_slopes.hpp"

#include "cablefit/samples/weigh/fitted_slopes.hpp"

namespace cablefit::weighing {

TorqueSlopes fit_torques(const CoarsePart& part) {
  const auto n_joints = static_cast<Eigen::Index>(part.joints.size());
  const auto n_rows = static_cast<Eigen::Index>(part.inner.size());
  Eigen::MatrixXd columns(n_rows, 3 * n_joints + 2);
  for (Eigen::Index j = 0; j < n_joints; ++j) {
    const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
    columns.col(j) = at_inner(part, joint.theta);
    columns.col(n_joints + j) = at_inner(part, joint.q);
    columns.col(2 * n_joints + j) = coarse_rates(part, joint.theta).second;
  }
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n_joints, n_joints);
  TorqueSlopes slopes{zero, zero, Eigen::VectorX<bool>::Constant(n_joints, false), zero};
  for (Eigen::Index k = 0; k < n_joints; ++k) {
    const CoarsePart::Joint& motor = part.joints[static_cast<std::size_t>(k)];
    columns.col(3 * n_joints) = coarse_rates(part, motor.theta).first;
    columns.col(3 * n_joints + 1) = columns.col(3 * n_joints).array().sign();
    const FittedSlopes fit = fitted_slopes(columns, at_inner(part, motor.tau));
    if (!fit.is_known()) continue;
    slopes.theta.row(k) = fit.value.head(n_joints);
    slopes.q.row(k) = fit.value.segment(n_joints, n_joints);
    slopes.is_clear(k) = fit.is_clear(k);
    for (Eigen::Index j = 0; j < n_joints; ++j)
      if (fit.is_clear(n_joints + j)) slopes.clear_q(k, j) = slopes.q(k, j);
  }
  return slopes;
}

}  // namespace cablefit::weighing
