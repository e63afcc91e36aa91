#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/stiff_motors.hpp"
#include "cablefit/samples/weigh/torque_slopes.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kCloser = 3;       // times do motors follow the links, where torques say so too
constexpr double kFarCloser = 10;   // by the positions alone
constexpr double kFollowing = 0.1;  // of the motion: the same
constexpr double kAgree = 0.5;      // distance of slopes over q from those expected, of their size

bool has_all(const LogPlan& plan) {
  for (int j = 0; j < plan.rig.n_joints(); ++j)
    for (const Channel channel : {Channel::q, Channel::theta, Channel::tau})
      if (!plan.has_measured(channel, j)) return false;
  return true;
}

/// The torque follows theta - S q, as that of cables does, with a negative stiffness. A motor that
/// holds against others has one over theta too, its controller's, but none over q.
bool is_motor_reversed(const TorqueSlopes& slopes, const Eigen::MatrixXd& stiff, Eigen::Index k) {
  if (!(slopes.is_clear(k) && slopes.theta(k, k) < 0)) return false;
  const Eigen::RowVectorXd expected = -(slopes.theta.row(k) * stiff);
  return (slopes.q.row(k) - expected).norm() < kAgree * expected.norm();
}

Finding reversed_motor(const LogPlan& plan, const CoarsePart& part, double slope, int joint) {
  const auto name = [&](Channel channel) { return weighed_name(plan, channel, joint); };
  return {part.log,
          {},
          true,
          fmt::format("{0} is reversed against {1} and {2}: it falls as {2} grows while the links "
                      "stay (slope {3:.3g} {4})",
                      name(Channel::tau), name(Channel::q), name(Channel::theta), slope,
                      unit_for(plan.rig.axes.of(joint), "N m/rad")),
          mending_line(plan, Channel::tau, joint, -1)};
}

/// Which channels of a joint change their sign.
struct Turn {
  bool q = false, theta = false;
};

/// Rms distance of the motors that the joint has to do with from where stiff cables would have
/// them, of the rms of their motion.
double distance(const CoarsePart& part, const Eigen::MatrixXd& stiff, int joint, Turn turn) {
  Eigen::MatrixXd turned = stiff;
  if (turn.q) turned.col(joint) *= -1;
  if (turn.theta) turned.row(joint) *= -1;
  double off = 0, all = 0;
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    const auto motor = static_cast<int>(j);
    const Eigen::ArrayXd& theta = part.joints[j].theta;
    const double motion = (theta - theta.mean()).square().mean();
    if ((motor != joint && stiff(motor, joint) == 0) || !(motion > 0)) continue;
    const Eigen::ArrayXd from = theta - stiff_theta(turned, part, motor);
    off += (from - from.mean()).square().mean() / motion;
    ++all;
  }
  return all > 0 ? std::sqrt(off / all) : 0;
}

/// What the torques say of the signs of q and theta of one joint.
enum class Torques { silent, right, wrong };

Torques torques_say(const TorqueSlopes& slopes, const Eigen::MatrixXd& stiff, int joint) {
  const Eigen::VectorXd expected = -(slopes.theta * stiff.col(joint));
  const double agreement = slopes.clear_q.col(joint).dot(expected);
  return agreement < 0 ? Torques::wrong : agreement > 0 ? Torques::right : Torques::silent;
}

/// Whether torque and theta of a motor have the same sign, as far as is known.
bool is_torque_of_motor(const TorqueSlopes& slopes, int joint) {
  return !(slopes.is_clear(joint) && slopes.theta(joint, joint) < 0);
}

struct TurnedJoint {
  Turn turn;
  double as_it_is = 0, turned = 0;  ///< distances
};

/// A joint whose motors follow the links with other signs. Of a link that swings against its motor,
/// beyond the resonance, the torques say that the signs are right.
std::optional<TurnedJoint> turned_joint(const CoarsePart& part, const TorqueSlopes& slopes,
                                        const Eigen::MatrixXd& stiff, int joint) {
  const auto off = [&](Turn turn) { return distance(part, stiff, joint, turn); };
  const bool by_link = is_torque_of_motor(slopes, joint);  // where the two are as good
  Turn one{by_link, !by_link}, other{!by_link, by_link};
  if (kCloser * off(other) < off(one)) one = other;
  const double as_it_is = off({}), by_one = off(one), by_both = off({true, true});
  const Torques torques = torques_say(slopes, stiff, joint);
  const auto is_far = [&](double turned) {
    return kFarCloser * turned < as_it_is && turned < kFollowing;
  };
  if (by_one <= by_both) {
    const bool is_sure = torques == Torques::wrong ? kCloser * by_one < as_it_is
                                                   : torques == Torques::silent && is_far(by_one);
    if (is_sure) return TurnedJoint{one, as_it_is, by_one};
  } else if (is_far(by_both)) {
    return TurnedJoint{{true, true}, as_it_is, by_both};
  }
  return std::nullopt;
}

Finding turned_finding(const LogPlan& plan, const CoarsePart& part, const TurnedJoint& found,
                       bool with_tau, int joint) {
  const auto name = [&](Channel channel) { return weighed_name(plan, channel, joint); };
  const auto mend = [&](Channel channel) { return mending_line(plan, channel, joint, -1); };
  const std::string q = name(Channel::q), theta = name(Channel::theta), tau = name(Channel::tau);
  const std::string drive = with_tau ? theta + " and " + tau : theta;
  std::string what, remedy;
  if (found.turn.q && found.turn.theta) {
    what = fmt::format("{}, {} and {} are reversed against the cables", q, theta, tau);
    remedy = fmt::format("{}, and the same of {} and {}, or all of a joint that shares its cables",
                         mend(Channel::q), theta, tau);
  } else if (found.turn.q) {
    what = q + " is reversed";
    remedy = fmt::format("{}, or the same of {}", mend(Channel::q), drive);
  } else {
    what = drive + (with_tau ? " are reversed" : " is reversed");
    remedy = mend(Channel::theta) + (with_tau ? ", and the same of " + tau : "");
  }
  return {part.log,
          {},
          true,
          fmt::format("{}: the motors are {:.0f} % of their motion away from the links, with the "
                      "other sign {:.2g} %",
                      what, 100 * found.as_it_is, 100 * found.turned),
          remedy};
}

}  // namespace

Findings reversed_joints(const Logs& logs) {
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
      else if (const auto turned = turned_joint(part, slopes, stiff, j))
        findings.push_back(turned_finding(plan, part, *turned, is_torque_of_motor(slopes, j), j));
    }
  }
  return findings;
}

}  // namespace cablefit::weighing
