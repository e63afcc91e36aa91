#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "cablefit/samples/weigh/checks.hpp"
#include "cablefit/samples/weigh/limits.hpp"
#include "cablefit/samples/weigh/stiff_motors.hpp"

namespace cablefit::weighing {
namespace {

// Elastic cables, friction and other joints lower the correlation of joints that are not swapped:
// the swap has to explain at least this many times as much of the motion that is left.
constexpr double kFarBetter = 5;

/// Correlation of the motors of two joints with where stiff cables would have them.
using Pair = std::array<double, 2>;

double lower_of(const Pair& pair) { return std::min(pair[0], pair[1]); }

/// `motors`: whose theta is compared with that of joints a and b.
Pair correlations(const Eigen::MatrixXd& stiff, const CoarsePart& part, std::pair<int, int> joints,
                  std::pair<int, int> motors) {
  const auto correlation = [&](int joint, int motor) {
    return coarse_line(stiff_theta(stiff, part, joint),
                       part.joints[static_cast<std::size_t>(motor)].theta)
        .correlation;
  };
  return {correlation(joints.first, motors.first), correlation(joints.second, motors.second)};
}

/// The part with the links of two joints exchanged.
CoarsePart with_swapped_links(CoarsePart part, std::pair<int, int> joints) {
  std::swap(part.joints[static_cast<std::size_t>(joints.first)].q,
            part.joints[static_cast<std::size_t>(joints.second)].q);
  return part;
}

/// Both motors follow after the swap, and neither does as it is.
bool is_clear(const Pair& own, const Pair& swapped) {
  for (std::size_t k = 0; k < 2; ++k)
    if (own[k] > kFollows || 1 - own[k] < kFarBetter * (1 - swapped[k])) return false;
  return lower_of(swapped) > kFollows;
}

/// `which`: "theta1 and theta2", as the question names them.
Finding finding_of(const LogPlan& plan, const CoarsePart& part, std::pair<int, int> joints,
                   const std::string& which, const Pair& own, const Pair& swapped) {
  const auto [a, b] = joints;
  return {
      part.log,
      {},
      true,
      fmt::format("joints {} and {}: are {}? {} and {} follow their own links with "
                  "correlations of {:.2f} and {:.2f}, swapped {:.2f} and {:.2f}",
                  a + 1, b + 1, which, weighed_name(plan, Channel::theta, a),
                  weighed_name(plan, Channel::theta, b), own[0], own[1], swapped[0], swapped[1]),
      "exchange their columns in the rig file; if tau was recorded in the order of theta, or "
      "tau_load in that of q, exchange those too"};
}

/// "theta1 and theta2 swapped"; where no cable couples the joints nothing shows which they are.
std::string swapped_names(const LogPlan& plan, std::pair<int, int> joints, double drives,
                          double links) {
  constexpr double kSame = 1e-6;
  const auto pair = [&](Channel channel) {
    return fmt::format("{} and {}", weighed_name(plan, channel, joints.first),
                       weighed_name(plan, channel, joints.second));
  };
  if (drives > links + kSame) return pair(Channel::theta) + " swapped";
  if (links > drives + kSame) return pair(Channel::q) + " swapped";
  return fmt::format("{} swapped, or {}", pair(Channel::theta), pair(Channel::q));
}

std::optional<Finding> find_swap(const LogPlan& plan, const CoarsePart& part,
                                 const Eigen::MatrixXd& stiff, std::pair<int, int> joints) {
  const std::pair<int, int> crossed{joints.second, joints.first};
  const Pair own = correlations(stiff, part, joints, joints);
  const Pair drives = correlations(stiff, part, joints, crossed);
  const Pair links = correlations(stiff, with_swapped_links(part, joints), joints, joints);
  const double by_drives = lower_of(drives), by_links = lower_of(links);
  const Pair& swapped = by_drives >= by_links ? drives : links;
  if (!is_clear(own, swapped)) return std::nullopt;
  return finding_of(plan, part, joints, swapped_names(plan, joints, by_drives, by_links), own,
                    swapped);
}

bool shows_swaps(const Logs& logs, const CoarsePart& part) {
  const LogPlan& plan = logs.plan(part);
  const int n = plan.rig.n_joints();
  if (n < 2 || part.t.size() < kFewBlocks || logs.survey(part).phase != Phase::moving) return false;
  for (int j = 0; j < n; ++j)
    if (!plan.has_measured(Channel::q, j) || !plan.has_measured(Channel::theta, j)) return false;
  return true;
}

}  // namespace

Findings swapped_joints(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    if (!shows_swaps(logs, part)) continue;
    const LogPlan& plan = logs.plan(part);
    const Eigen::MatrixXd stiff = stiff_motors(plan.rig);
    if (stiff.size() == 0) continue;
    for (int a = 0; a < plan.rig.n_joints(); ++a)
      for (int b = a + 1; b < plan.rig.n_joints(); ++b)
        if (auto finding = find_swap(plan, part, stiff, {a, b}))
          findings.push_back(*std::move(finding));
  }
  return findings;
}

}  // namespace cablefit::weighing
