#include <fmt/format.h>

#include <cmath>
#include <string>

#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/fitted_slopes.hpp"
#include "cablefit/samples/weigh/stiff_motors.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kFarBetter = 3;  // times closer do motors follow the links
constexpr double kAgree = 0.5;    // distance of slopes over q from those expected, of their size

/// Slopes of the torque of every motor (rows) over all theta and all q, beside accelerations and
/// friction. Cables make them K and -K S, S as in stiff_motors.hpp, with a positive diagonal of K,
/// as (6) is convex. A row of 0: not known.
struct TorqueSlopes {
  Eigen::MatrixXd theta, q;
  Eigen::VectorX<bool> is_clear;  ///< the diagonal of theta
  Eigen::MatrixXd clear_q;        ///< q where it is clear, else 0
};

bool has_all(const LogPlan& plan) {
  for (int j = 0; j < plan.rig.n_joints(); ++j)
    for (const Channel channel : {Channel::q, Channel::theta, Channel::tau})
      if (!plan.has_measured(channel, j)) return false;
  return true;
}

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

/// The torque follows theta - S q, as that of cables does, with a negative stiffness. A motor that
/// holds against others has one over theta too, its controller's, but none over q.
bool is_motor_reversed(const TorqueSlopes& slopes, const Eigen::MatrixXd& stiff, Eigen::Index k) {
  if (!(slopes.is_clear(k) && slopes.theta(k, k) < 0)) return false;
  const Eigen::RowVectorXd expected = -(slopes.theta.row(k) * stiff);
  return (slopes.q.row(k) - expected).norm() < kAgree * expected.norm();
}

Finding reversed_motor(const LogPlan& plan, const CoarsePart& part, double slope, int joint) {
  const std::string tau = weighed_name(plan, Channel::tau, joint),
                    theta = weighed_name(plan, Channel::theta, joint);
  return {part.log,
          {},
          true,
          fmt::format("{0} falls as {1} grows while the links stay (slope {2:.3g} {3}): {0} or {1} "
                      "is reversed",
                      tau, theta, slope, unit_for(plan.rig.axes.of(joint), "N m/rad")),
          mending_line(plan, Channel::tau, joint, -1) + ", or the same of " + theta};
}

/// Rms distance of the motors that this link moves from where stiff cables would have them, of the
/// rms of their motion.
double distance(const CoarsePart& part, const Eigen::MatrixXd& stiff, int link) {
  double off = 0, all = 0;
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    const auto motor = static_cast<int>(j);
    const Eigen::ArrayXd& theta = part.joints[j].theta;
    const double motion = (theta - theta.mean()).square().mean();
    if (stiff(motor, link) == 0 || !(motion > 0)) continue;
    const Eigen::ArrayXd from = theta - stiff_theta(stiff, part, motor);
    off += (from - from.mean()).square().mean() / motion;
    ++all;
  }
  return all > 0 ? std::sqrt(off / all) : 0;
}

/// A link is reversed where motors follow it with the other sign, and the torques say so too: of a
/// link that swings against its motor, beyond the resonance, they do not.
void add_reversed_link(const LogPlan& plan, const CoarsePart& part, const TorqueSlopes& slopes,
                       const Eigen::MatrixXd& stiff, int joint, Findings& findings) {
  const Eigen::VectorXd expected = -(slopes.theta * stiff.col(joint));
  if (!(slopes.clear_q.col(joint).dot(expected) < 0)) return;
  Eigen::MatrixXd turned = stiff;
  turned.col(joint) *= -1;
  const double as_it_is = distance(part, stiff, joint), mended = distance(part, turned, joint);
  if (!(kFarBetter * mended < as_it_is)) return;
  const std::string q = weighed_name(plan, Channel::q, joint);
  findings.push_back(
      {part.log,
       {},
       true,
       fmt::format("{0} is reversed: the motors are off the links by {1:.2g} % of "
                   "their motion, with -{0} by {2:.2g} %, and the torques confirm it",
                   q, 100 * as_it_is, 100 * mended),
       mending_line(plan, Channel::q, joint, -1)});
}

}  // namespace

Findings motor_slopes(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    if (logs.survey(part).phase != Phase::moving || !has_all(plan)) continue;
    const Eigen::MatrixXd stiff = stiff_motors(plan.rig);
    if (stiff.size() == 0) continue;
    const TorqueSlopes slopes = fit_torques(part);
    for (int j = 0; j < plan.rig.n_joints(); ++j) {
      if (is_motor_reversed(slopes, stiff, j))
        findings.push_back(reversed_motor(plan, part, slopes.theta(j, j), j));
      else
        add_reversed_link(plan, part, slopes, stiff, j, findings);
    }
  }
  return findings;
}

}  // namespace cablefit::weighing
