#include <fmt/format.h>

#include <cmath>
#include <map>

#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/fitted_slopes.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kRounding = 1e-9;   // of theta: a smaller range is no motion
constexpr double kClearSlope = 0.7;  // correlation of torque and deflection
constexpr double kOtherUnit =
    5;  // ratio of the slopes of two logs; a cable that softens stays below

constexpr double kNoSlope = 0.3;     // of a log that only seems blocked
constexpr double kDeadRange = 0.05;  // rad; less is a deflection
constexpr Eigen::Index kFewSamples = 50;

/// The link was taken for blocked since q stands still, but tau does not follow theta.
bool has_dead_q(const PartSurvey& survey, const CoarsePart::Joint& joint, const CoarseLine& line) {
  return !survey.phase_given && joint.tau.size() > kFewSamples &&
         std::abs(line.correlation) < kNoSlope && coarse_range(joint.theta) > kDeadRange;
}

/// Of several joints with blocked links, d tau_j / d theta_j of a fit to all thetas: positive for
/// whatever cables the joints share, as (6) is convex. 0: the log does not determine it.
double own_slope(const CoarsePart& part, std::size_t joint) {
  const Eigen::ArrayXd& tau = part.joints[joint].tau;
  const auto n = static_cast<Eigen::Index>(part.joints.size());
  Eigen::MatrixXd columns(tau.size(), n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::ArrayXd& theta = part.joints[static_cast<std::size_t>(k)].theta;
    if (theta.size() != tau.size()) return 0;
    columns.col(k) = theta;
  }
  const FittedSlopes slopes = fitted_slopes(columns, tau);
  const auto own = static_cast<Eigen::Index>(joint);
  return slopes.is_known() && slopes.is_clear(own) ? slopes.value(own) : 0;
}

/// Joints whose torque falls as their own drive winds up.
void add_reversed_joints(const CoarsePart& part, const LogPlan& plan, Findings& findings) {
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    const double slope = own_slope(part, j);
    if (!(slope < 0)) continue;
    const int joint = static_cast<int>(j);
    const std::string tau = weighed_name(plan, Channel::tau, joint),
                      theta = weighed_name(plan, Channel::theta, joint);
    findings.push_back(
        {part.log,
         {},
         true,
         fmt::format("{0} falls as {1} grows while the links are blocked (slope {2:.3g} {3}): {0} "
                     "or {1} is reversed",
                     tau, theta, slope, unit_for(plan.rig.axes.of(joint), "N m/rad")),
         mending_line(plan, Channel::tau, joint, -1) + ", or the same of " + theta});
  }
}

struct BlockedSlope {
  const CoarsePart* part;
  CoarseLine line;
};

}  // namespace

Findings blocked_slope(const Logs& logs) {
  Findings findings;
  std::map<std::string, BlockedSlope> first;  // by rig, preload and joint
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    if (logs.survey(part).phase != Phase::blocked) continue;
    if (plan.rig.n_joints() > 1) {
      add_reversed_joints(part, plan, findings);
      continue;
    }
    const CoarsePart::Joint& joint = part.joints.front();
    if (joint.tau.size() == 0 || joint.theta.size() == 0) continue;
    const CoarseLine line = coarse_line(joint.theta, joint.tau);
    if (has_dead_q(logs.survey(part), joint, line))
      findings.push_back(
          {part.log,
           {},
           true,
           fmt::format("q stands still while theta moves {:.3g}, and tau does not follow theta "
                       "(correlation {:.2f}): is the sensor of q dead, or q another column?",
                       coarse_range(joint.theta), line.correlation),
           "read q from the column of the link's encoder; of a link that is blocked, give a column "
           "'phase' with 'blocked'"});
    const double middle = joint.theta.abs().maxCoeff();
    const bool is_still = coarse_range(joint.theta) <= kRounding * middle;
    if (is_still || std::abs(line.correlation) < kClearSlope) continue;
    if (line.slope < 0) {
      findings.push_back(
          {part.log,
           {},
           true,
           fmt::format(
               "tau falls as theta grows while the link is blocked (slope {:.3g} {}): tau or "
               "theta is reversed",
               line.slope, unit_for(plan.rig.axes.all(), "N m/rad")),
           mending_line(plan, Channel::tau, 0, -1) + ", or the same of theta"});
      continue;
    }
    const std::string key = plan.rig.path + '\n' + logs.survey(part).preload;
    const auto [found, is_new] = first.insert({key, {&part, line}});
    if (is_new) continue;
    const double ratio = line.slope / found->second.line.slope;
    if (ratio < kOtherUnit && ratio > 1 / kOtherUnit) continue;
    findings.push_back(
        {part.log,
         {},
         true,
         fmt::format("tau per theta is {:.3g} times that of {}, with the same rig and preload",
                     ratio, logs.plan(*found->second.part).path),
         "give each log its own unit or scale, or its own preload",
         false,
         true});
  }
  return findings;
}

}  // namespace cablefit::weighing
