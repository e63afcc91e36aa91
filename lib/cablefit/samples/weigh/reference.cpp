#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/quote.hpp"
#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/limits.hpp"

namespace cablefit::weighing {
namespace {

/// Odd only: a controller's reference need not be theta's.
Finding odd_reference(const LogPlan& plan, const CoarsePart& part, int joint,
                      const CoarseLine& line) {
  const double slope = line.slope;
  const std::string reference = weighed_name(plan, Channel::theta_ref, joint);
  const std::string theta = weighed_name(plan, Channel::theta, joint);
  const double size = std::abs(slope);
  const auto finding = [&](const std::string& what, const std::string& remedy) {
    return Finding{part.log, {}, false, what, remedy};
  };
  if (size > kLowRatio && size < kHighRatio)
    return finding(
        fmt::format("{} is reversed: its slope on {} is {:.2f}", reference, theta, slope),
        mending_line(plan, Channel::theta_ref, joint, -1));
  const std::string more =
      fmt::format("{} moves {:.3g} times as much as {}", reference, slope, theta);
  if (std::abs(slope / kDegrees - 1) < kSameUnit && plan.rig.axes.of(joint) == Axes::rotary)
    return finding(more + ": degrees?", mending_unit(plan, Channel::theta_ref, joint, "deg"));
  return finding(more + ": a unit or a reduction?",
                 measured_line(plan, Channel::theta_ref, joint, 1 / slope,
                               usual_slope_error(line.correlation), "ratio"));
}

/// The controller's own reference is not in the log; a column theta_ref may be.
std::optional<Finding> other_reference(const LogPlan& plan, std::size_t log, int joint) {
  const std::string usual = Controller{}.reference;
  if (!plan.rig.controller || plan.rig.controller->reference == usual) return {};
  if (plan.has(Channel::theta_ref, joint)) return {};
  const std::vector<ColumnHeader>& columns = plan.header.columns;
  const bool has_usual =
      std::any_of(columns.begin(), columns.end(), [&](const ColumnHeader& column) {
        return column.name == usual || column.name == usual + "1";
      });
  return Finding{log,
                 {},
                 false,
                 fmt::format("the controller's reference {} is not a column of the log{}",
                             in_quotes(reference_name(plan.rig, joint)),
                             has_usual ? ", and " + usual + " is not used" : ""),
                 fmt::format("write the column's name as \"reference\"{}",
                             has_usual ? ", or \"" + usual + "\"" : "")};
}

}  // namespace

Findings reference(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    if (logs.survey(part).phase != Phase::moving) continue;
    const LogPlan& plan = logs.plan(part);
    for (int j = 0; j < plan.rig.n_joints(); ++j) {
      const CoarsePart::Joint& joint = part.joints[static_cast<std::size_t>(j)];
      if (const auto other = other_reference(plan, part.log, j)) findings.push_back(*other);
      if (joint.theta.size() == 0 || joint.theta_ref.size() == 0) continue;
      const CoarseLine line = coarse_line(joint.theta, joint.theta_ref);
      if (std::abs(line.correlation) < kFollows) continue;
      if (line.slope > kLowRatio && line.slope < kHighRatio) continue;
      findings.push_back(odd_reference(plan, part, j, line));
    }
  }
  return findings;
}

}  // namespace cablefit::weighing
