#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/limits.hpp"
#include "cablefit/samples/weigh/stiff_motors.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kMostTurns = 2;  // of a link that cables hold
constexpr double kOddTurns = 1;
constexpr double kMostDeflection = 2;  // rad, against a blocked link
constexpr double kLinkMoves = 0.05;  // rad; the compliance of what blocks a link lets it move less
constexpr double kSmallTorque = 1;   // N m; positions read as torque stay below
constexpr double kAlike = 0.99, kLowAlike = 0.8, kHighAlike = 1.25;
constexpr double kGear = 5;     // a larger ratio is no resonance
constexpr double kSine = 0.95;  // correlation of a position and its acceleration
constexpr double kMuchSmaller = 0.2;
constexpr double kSameMotion = 0.995;  // correlation of a link that only looks blocked
constexpr double kStandsStill = 0.02;  // of the other position's range

struct UnitRatio {
  double ratio;
  const char* unit;
  const char* symbol;
};
constexpr std::array<UnitRatio, 2> kAngles = {
    {{kDegrees, "degrees", "deg"}, {1000, "mrad", "mrad"}}};
constexpr std::array<UnitRatio, 2> kLengths = {{{1000, "mm", "mm"}, {100, "cm", "cm"}}};
std::span<const UnitRatio> unit_ratios(Axes axes) {
  return axes == Axes::linear ? std::span<const UnitRatio>(kLengths) : kAngles;
}
constexpr double kTurn = 2 * std::numbers::pi;

bool has_unit(const LogPlan& plan, Channel channel, int joint) {
  return plan.slots[static_cast<std::size_t>(plan.find(channel, joint))].has_unit;
}

Finding ratio_finding(const LogPlan& plan, const CoarsePart& part, int joint,
                      const CoarseLine& line) {
  const double slope = line.slope;
  const std::string theta = weighed_name(plan, Channel::theta, joint);
  const std::string q = weighed_name(plan, Channel::q, joint);
  const double size = std::abs(slope);
  const auto finding = [&](const std::string& what, const std::string& remedy) {
    return Finding{part.log, {}, true, what, remedy};
  };
  const auto is = [&](double x, double unit) { return std::abs(x / unit - 1) < kSameUnit; };
  for (const UnitRatio& unit : unit_ratios(plan.rig.axes.of(joint))) {
    const bool by_theta = is(size, unit.ratio);
    if (!by_theta && !is(1 / size, unit.ratio)) continue;
    // The unit is missing on one side, or wrongly given on the other.
    const Channel larger = by_theta ? Channel::theta : Channel::q;
    const Channel smaller = by_theta ? Channel::q : Channel::theta;
    const bool given = has_unit(plan, smaller, joint) && !has_unit(plan, larger, joint);
    return finding(
        fmt::format("{} moves {:.1f} times as much as {}: {} {}in {}?", by_theta ? theta : q,
                    by_theta ? slope : 1 / slope, by_theta ? q : theta,
                    weighed_name(plan, given ? smaller : larger, joint), given ? "not " : "",
                    unit.unit),
        given ? fmt::format("take the unit of {} out of the rig file or the header",
                            weighed_name(plan, smaller, joint))
              : mending_unit(plan, larger, joint, unit.symbol));
  }
  const std::string more =
      fmt::format("{} moves {:.3g} times as much as {}: ", theta, nice_factor(slope), q);
  if (plan.rig.axes.of(joint) == Axes::rotary && (is(size, kTurn) || is(1 / size, kTurn))) {
    const Channel turns = is(size, kTurn) ? Channel::q : Channel::theta;
    return finding(
        fmt::format("{}{} in revolutions, or a reduction?", more, weighed_name(plan, turns, joint)),
        mending_unit(plan, turns, joint, "rev"));
  }
  return finding(more + "a reduction?",
                 measured_line(plan, Channel::theta, joint, 1 / slope,
                               largest_slope_error(line.correlation), "ratio"));
}

/// Work of the drive says which of two positions that run against each other is turned.
bool drive_turns_back(const CoarsePart& part, const CoarsePart::Joint& joint) {
  if (joint.tau.size() == 0) return false;
  const Eigen::ArrayXd power = at_inner(part, joint.tau) * coarse_rates(part, joint.theta).first;
  return power.sum() < 0;
}

/// Two channels hold the same quantity: one of them is read from the other's column.
bool are_alike(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) {
  const CoarseLine line = coarse_line(a, b);
  return std::abs(line.correlation) > kAlike && line.slope > kLowAlike && line.slope < kHighAlike;
}

Finding swapped(const LogPlan& plan, const CoarsePart& part, int joint, const std::string& why,
                Channel one, Channel other) {
  return {part.log,
          {},
          true,
          fmt::format("{}: are {} and {} swapped?", why, weighed_name(plan, one, joint),
                      weighed_name(plan, other, joint)),
          "exchange their columns in the rig file"};
}

/// Columns that changed places, of one joint. `expected`: where theta would be on stiff cables.
std::optional<Finding> swapped_columns(const LogPlan& plan, const CoarsePart& part, int j,
                                       const Eigen::ArrayXd& expected) {
  const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
  if (joint.tau.size() == 0) return std::nullopt;
  const auto name = [&](Channel channel) { return weighed_name(plan, channel, j); };
  const auto alike = [&](Channel a, Channel b) {
    return fmt::format("{} and {} are alike", name(a), name(b));
  };
  if (std::abs(coarse_line(expected, joint.theta).correlation) > kFollows) return std::nullopt;
  if (are_alike(expected, joint.tau))
    return swapped(plan, part, j, alike(Channel::tau, Channel::q), Channel::tau, Channel::theta);
  const double theta_range = coarse_range(joint.theta), q_range = coarse_range(expected);
  if (are_alike(joint.theta, joint.tau) && theta_range < kMuchSmaller * q_range)
    return swapped(plan, part, j, alike(Channel::tau, Channel::theta), Channel::tau, Channel::q);
  // Not where the link itself stands still, and others move its cables.
  if (theta_range < kStandsStill * std::min(q_range, coarse_range(joint.q)))
    return swapped(
        plan, part, j,
        fmt::format("{} stands still while {} moves", name(Channel::theta), name(Channel::q)),
        Channel::q, Channel::theta);
  return std::nullopt;
}

/// Of a motor wired backwards theta and tau are reversed, which looks the same as a reversed q.
Finding turned_position(const LogPlan& plan, const CoarsePart& part, int j, double slope) {
  const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
  const auto name = [&](Channel channel) { return weighed_name(plan, channel, j); };
  const Channel turned = drive_turns_back(part, joint) ? Channel::theta : Channel::q;
  std::string remedy = mending_line(plan, turned, j, -1);
  if (turned == Channel::q && joint.tau.size() > 0)
    remedy += fmt::format(", or the same of {} and {}", name(Channel::theta), name(Channel::tau));
  return {part.log,
          {},
          true,
          fmt::format("{} is reversed: the slope of {} on {} is {:.2f}", name(turned),
                      name(Channel::theta), name(Channel::q), slope),
          std::move(remedy)};
}

/// Of a single sine near a resonance q and theta differ in size and sign for a good reason.
bool is_one_sine(const CoarsePart& part, const Eigen::ArrayXd& x) {
  if (part.inner.size() < static_cast<std::size_t>(kFewBlocks)) return false;
  const CoarseLine line = coarse_line(coarse_rates(part, x).second, at_inner(part, x));
  return line.slope < 0 && std::abs(line.correlation) > kSine;
}

std::optional<Finding> weigh_ratio(const LogPlan& plan, const CoarsePart& part, int j,
                                   const Eigen::ArrayXd& expected) {
  const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
  const CoarseLine line = coarse_line(expected, joint.theta);
  if (std::abs(line.correlation) < kFollows) return std::nullopt;
  const double size = std::abs(line.slope);
  const bool usual = size > kLowRatio && size < kHighRatio;
  if (usual && line.slope > 0) return std::nullopt;
  if (size > 1 / kGear && size < kGear && is_one_sine(part, expected)) return std::nullopt;
  // Without torque, a link that swings on a drive at rest may run against it.
  if (joint.tau.size() == 0 && size < kHighRatio) return std::nullopt;
  if (usual) return turned_position(plan, part, j, line.slope);
  return ratio_finding(plan, part, j, line);
}

bool is_unit_ratio(Axes axes, double slope) {
  const std::span<const UnitRatio> units = unit_ratios(axes);
  return std::any_of(units.begin(), units.end(), [&](const UnitRatio& unit) {
    return std::abs(slope / unit.ratio - 1) < kSameUnit ||
           std::abs(1 / slope / unit.ratio - 1) < kSameUnit;
  });
}

/// Of two units, or before a gear, a moving link can look blocked; a blocked one follows theta by
/// the compliance of what blocks it.
bool weighs_ratio(const Logs& logs, const CoarsePart& part, int j, const Eigen::ArrayXd& expected) {
  const PartSurvey& survey = logs.survey(part);
  if (survey.phase == Phase::moving || survey.phase_given) return survey.phase == Phase::moving;
  const CoarseLine line = coarse_line(expected, part.joints[static_cast<std::size_t>(j)].theta);
  const bool moves =
      logs.plan(part).rig.axes.of(j) == Axes::rotary && coarse_range(expected) > kLinkMoves;
  return std::abs(line.correlation) > kSameMotion &&
         (moves || is_unit_ratio(logs.plan(part).rig.axes.of(j), line.slope));
}

void weigh_columns(const Logs& logs, const CoarsePart& part, Findings& findings) {
  const LogPlan& plan = logs.plan(part);
  const Eigen::MatrixXd stiff = stiff_motors(plan.rig);
  const int n = plan.rig.n_joints();
  for (int j = 0; j < n; ++j)
    if (!plan.has_measured(Channel::q, j) || !plan.has_measured(Channel::theta, j)) return;
  if (stiff.size() == 0 || part.t.size() < kFewBlocks) return;
  for (int j = 0; j < n; ++j) {
    const Eigen::ArrayXd expected = stiff_theta(stiff, part, j);
    std::optional<Finding> finding;
    if (weighs_ratio(logs, part, j, expected)) finding = weigh_ratio(plan, part, j, expected);
    if (!finding) finding = swapped_columns(plan, part, j, expected);
    if (finding) findings.push_back(*std::move(finding));
  }
}

void weigh_range(const Logs& logs, const CoarsePart& part, Findings& findings) {
  const LogPlan& plan = logs.plan(part);
  const bool blocked = logs.survey(part).phase == Phase::blocked;
  for (int j = 0; j < plan.rig.n_joints(); ++j) {
    if (plan.rig.axes.of(j) == Axes::linear) continue;
    if (!plan.has_measured(Channel::q, j) || !plan.has_measured(Channel::theta, j)) continue;
    const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
    const Channel channel = blocked ? Channel::theta : Channel::q;
    const double range = coarse_range(blocked ? joint.theta : joint.q);
    const double odd = blocked ? kMostDeflection : kOddTurns * kTurn;
    if (range < odd) continue;
    if (blocked && range > kTurn && joint.tau.size() > 0 &&
        coarse_range(joint.tau) < kSmallTorque) {
      findings.push_back(swapped(plan, part, j,
                                 fmt::format("{} moves {:.3g} rad while the link is blocked",
                                             weighed_name(plan, channel, j), range),
                                 Channel::theta, Channel::tau));
      continue;
    }
    findings.push_back(
        {part.log,
         {},
         range > (blocked ? kTurn : kMostTurns * kTurn),
         fmt::format("{} moves {:.3g} rad{}: degrees, or another column?",
                     weighed_name(plan, channel, j), range,
                     blocked ? " while the link is blocked" : ""),
         fmt::format("write \"unit\": \"deg\" of {} and {} in the rig file's columns",
                     weighed_name(plan, Channel::q, j), weighed_name(plan, Channel::theta, j))});
  }
}

}  // namespace

Findings positions(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) weigh_columns(logs, part, findings);
  if (!findings.empty()) return findings;
  for (const CoarsePart& part : logs.parts) weigh_range(logs, part, findings);
  return findings;
}

}  // namespace cablefit::weighing
