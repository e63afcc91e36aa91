#include <fmt/format.h>

#include <cmath>
#include <string>

#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/clear_slopes.hpp"
#include "cablefit/samples/weigh/stiff_motors.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kFarBetter = 3;  // times closer do motors follow the links on stiff cables

/// Slopes of the torque of every motor (rows) beside friction, 0 where not clear. Of a true log
/// inertias and the diagonal over theta are positive, as (6) is convex; those over q follow from
/// them, tau = K_theta (theta - S q), S as in stiff_motors.hpp.
struct MotorSlopes {
  Eigen::VectorXd inertia;
  Eigen::MatrixXd theta, q;
};

bool has_all(const LogPlan& plan) {
  for (int j = 0; j < plan.rig.n_joints(); ++j)
    for (const Channel channel : {Channel::q, Channel::theta, Channel::tau})
      if (!plan.has_measured(channel, j)) return false;
  return true;
}

MotorSlopes motor_slopes(const CoarsePart& part) {
  const auto n_joints = static_cast<Eigen::Index>(part.joints.size());
  const auto n_rows = static_cast<Eigen::Index>(part.inner.size());
  Eigen::MatrixXd columns(n_rows, 3 * n_joints + 2);
  for (Eigen::Index j = 0; j < n_joints; ++j) {
    const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
    columns.col(j) = coarse_rates(part, joint.theta).second;
    columns.col(n_joints + j) = at_inner(part, joint.theta);
    columns.col(2 * n_joints + j) = at_inner(part, joint.q);
  }
  MotorSlopes slopes{Eigen::VectorXd::Zero(n_joints), Eigen::MatrixXd::Zero(n_joints, n_joints),
                     Eigen::MatrixXd::Zero(n_joints, n_joints)};
  for (Eigen::Index k = 0; k < n_joints; ++k) {
    const CoarsePart::Joint& motor = part.joints[static_cast<std::size_t>(k)];
    columns.col(3 * n_joints) = coarse_rates(part, motor.theta).first;
    columns.col(3 * n_joints + 1) = columns.col(3 * n_joints).array().sign();
    const Eigen::VectorXd clear = clear_slopes(columns, at_inner(part, motor.tau));
    if (clear.size() == 0) continue;
    slopes.inertia(k) = clear(k);
    slopes.theta.row(k) = clear.segment(n_joints, n_joints);
    slopes.q.row(k) = clear.segment(2 * n_joints, n_joints);
  }
  return slopes;
}

/// What else could make the inertia or the stiffness negative does not make both so.
bool is_motor_reversed(const MotorSlopes& slopes, Eigen::Index k) {
  return slopes.inertia(k) < 0 && slopes.theta(k, k) < 0;
}

Finding reversed_motor(const LogPlan& plan, const CoarsePart& part, const MotorSlopes& slopes,
                       int joint) {
  const Axes axes = plan.rig.axes.of(joint);
  const std::string tau = weighed_name(plan, Channel::tau, joint),
                    theta = weighed_name(plan, Channel::theta, joint);
  return {part.log,
          {},
          true,
          fmt::format("{0} falls as {1} speeds up, and as {1} grows while the links stay (slopes "
                      "{2:.3g} {3} and {4:.3g} {5}): {0} or {1} is reversed",
                      tau, theta, slopes.inertia(joint), unit_for(axes, "kg m^2"),
                      slopes.theta(joint, joint), unit_for(axes, "N m/rad")),
          mending_line(plan, Channel::tau, joint, -1) + ", or the same of " + theta};
}

/// Distance of the motors from where stiff cables would have them, about its mean; rms.
double distance(const CoarsePart& part, const Eigen::MatrixXd& stiff) {
  double squares = 0;
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    const Eigen::ArrayXd off = part.joints[j].theta - stiff_theta(stiff, part, static_cast<int>(j));
    squares += (off - off.mean()).square().mean();
  }
  return std::sqrt(squares / static_cast<double>(part.joints.size()));
}

/// A link reads reversed where motors follow it with the other sign, and the torques say so too: of
/// a link that swings against its motor, beyond the resonance, they do not.
void add_reversed_link(const LogPlan& plan, const CoarsePart& part, const MotorSlopes& slopes,
                       const Eigen::MatrixXd& stiff, int joint, Findings& findings) {
  const Eigen::VectorXd expected = -(slopes.theta * stiff.col(joint));
  if (!(slopes.q.col(joint).dot(expected) < 0)) return;
  Eigen::MatrixXd turned = stiff;
  turned.col(joint) *= -1;
  const double as_it_is = distance(part, stiff), mended = distance(part, turned);
  if (!(kFarBetter * mended < as_it_is)) return;
  const std::string q = weighed_name(plan, Channel::q, joint);
  findings.push_back({part.log,
                      {},
                      true,
                      fmt::format("{0} is reversed: the motors follow the links to {1:.2g} {2} "
                                  "with -{0}, to {3:.2g} {2} as it is, and so do the torques",
                                  q, mended, unit_for(plan.rig.axes.of(joint), "rad"), as_it_is),
                      mending_line(plan, Channel::q, joint, -1)});
}

}  // namespace

Findings motor_slopes(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    if (logs.survey(part).phase != Phase::moving || !has_all(plan)) continue;
    const MotorSlopes slopes = motor_slopes(part);
    const Eigen::MatrixXd stiff = stiff_motors(plan.rig);
    for (int j = 0; j < plan.rig.n_joints(); ++j) {
      if (is_motor_reversed(slopes, j))
        findings.push_back(reversed_motor(plan, part, slopes, j));
      else if (stiff.size() > 0)
        add_reversed_link(plan, part, slopes, stiff, j, findings);
    }
  }
  return findings;
}

}  // namespace cablefit::weighing
