#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kAgrees = 0.2;        // relative
constexpr double kReversed = 0.05;     // relative: of the same size, with another sign
constexpr double kFollowsSpeed = 0.9;  // correlation
constexpr double kVelocityMatch = 0.05;
constexpr std::size_t kFewInner = 20;

struct SpeedUnit {
  double ratio;
  const char* name;
};
constexpr std::array<SpeedUnit, 3> kSpeedUnits = {{{180 / std::numbers::pi, "deg/s"},
                                                   {30 / std::numbers::pi, "rpm"},
                                                   {0.5 / std::numbers::pi, "rev/s"}}};

/// Simpson's mean over a block and its neighbours: what a central difference of the position sees.
Eigen::ArrayXd mean_speed(const CoarsePart& part, const Eigen::ArrayXd& w) {
  Eigen::ArrayXd mean(static_cast<Eigen::Index>(part.inner.size()));
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    const Eigen::Index i = part.inner[static_cast<std::size_t>(k)];
    mean(k) = (w(i - 1) + 4 * w(i) + w(i + 1)) / 6;
  }
  return mean;
}

}  // namespace

Findings velocity(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    for (int j = 0; j < plan.rig.n_joints(); ++j) {
      const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
      const bool by_theta = plan.has_measured(Channel::theta, j);
      const Eigen::ArrayXd& position = by_theta ? joint.theta : joint.q;
      if (joint.w.size() == 0 || (!by_theta && joint.q.size() == 0)) continue;
      if (part.inner.size() < kFewInner) continue;
      const CoarseLine line =
          coarse_line(coarse_rates(part, position).first, mean_speed(part, joint.w));
      if (std::abs(line.correlation) < kFollowsSpeed) continue;
      if (std::abs(line.slope - 1) < kAgrees) continue;
      const std::string w = weighed_name(plan, Channel::w, j);
      std::string guess;
      std::string remedy = std::abs(line.slope + 1) < kReversed
                               ? mending_line(plan, Channel::w, j, -1)
                               : measured_line(plan, Channel::w, j, 1 / line.slope,
                                               usual_slope_error(line.correlation), "factor");
      for (const SpeedUnit& unit : kSpeedUnits) {
        if (std::abs(line.slope / unit.ratio - 1) > kVelocityMatch) continue;
        guess = fmt::format(": {} in {}?", w, unit.name);
        remedy = mending_line(plan, Channel::w, j, 1 / unit.ratio);
      }
      findings.push_back(
          {part.log,
           {},
           line.slope < 0 || !guess.empty(),
           fmt::format("{} is {:.3g} times d{}/dt{}", w, line.slope,
                       weighed_name(plan, by_theta ? Channel::theta : Channel::q, j), guess),
           remedy});
    }
  }
  return findings;
}

}  // namespace cablefit::weighing
