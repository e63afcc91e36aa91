#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kReturned = 0.05;  // of the range: the motion is closed
constexpr double kNegative = -0.1;  // of the work exchanged; delays alone make less
constexpr double kClearlyNegative = -0.3;
constexpr double kMostLoad = 10;  // mean square, of the torque's
constexpr Eigen::Index kFewBlocksOfWork = 40;

struct Work {
  double drive = 0, load = 0;  // J
  double exchanged = 0;        // by the drive, back and forth
  /// Friction takes from what drive and load give together.
  double share() const { return exchanged > 0 ? (drive + load) / exchanged : 0; }
};

/// Number of blocks up to the last one at which every joint is back where it began.
Eigen::Index closed_blocks(const CoarsePart& part, Channel channel) {
  const auto position = [&](const CoarsePart::Joint& joint) -> const Eigen::ArrayXd& {
    return channel == Channel::q ? joint.q : joint.theta;
  };
  for (Eigen::Index i = part.t.size() - 1; i > 0; --i) {
    bool all = true;
    for (const CoarsePart::Joint& joint : part.joints) {
      const Eigen::ArrayXd& x = position(joint);
      all = all && std::abs(x(i) - x(0)) <= kReturned * coarse_range(x);
    }
    if (all) return i + 1;
  }
  return 0;
}

/// A load far beyond the torque is one in another unit.
bool has_load(const CoarsePart::Joint& joint) {
  return joint.load.size() > 0 &&
         joint.load.square().mean() < kMostLoad * joint.tau.square().mean();
}

/// Trapezoidal.
Work drive_work(const CoarsePart::Joint& joint, Channel channel, Eigen::Index n) {
  Work work;
  const Eigen::ArrayXd& x = channel == Channel::q ? joint.q : joint.theta;
  const bool with_load = has_load(joint);
  for (Eigen::Index i = 1; i < n; ++i) {
    const double step = (x(i) - x(i - 1)) / 2;
    const double d = (joint.tau(i) + joint.tau(i - 1)) * step;
    work.drive += d;
    work.exchanged += std::abs(d);
    if (with_load) work.load += (joint.load(i) + joint.load(i - 1)) * step;
  }
  return work;
}

/// Whether a cable or masses hand work from one joint to another.
bool are_coupled(const Rig& rig) {
  if (rig.arm.kind != nullptr) return true;
  const std::vector<Cable>& cables = rig.transmission.cables;
  return std::any_of(cables.begin(), cables.end(), [&](const Cable& cable) {
    int passed = 0;
    for (int joint = 0; joint < rig.n_joints(); ++joint)
      passed += cable.passes(static_cast<std::size_t>(joint)) ? 1 : 0;
    return passed > 1;
  });
}

/// A drive that takes work, and whether other joints may give it: through cables or masses, and all
/// drives together work against friction.
struct Braking {
  int joint = -1;  ///< -1: all drive
  Work work;
  bool may_be_moved = false;
};

/// Joints hand work to one another, so that of several one has to brake clearly.
Braking braking_joint(const CoarsePart& part, Channel channel, Eigen::Index n, const Rig& rig) {
  const double limit = part.joints.size() == 1 ? kNegative : kClearlyNegative;
  Braking found;
  Work all;
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    const Work work = drive_work(part.joints[j], channel, n);
    all.drive += work.drive;
    all.load += work.load;
    const bool more = found.joint < 0 || work.exchanged > found.work.exchanged;
    if (work.share() < limit && more) found = {static_cast<int>(j), work, false};
  }
  found.may_be_moved = all.drive + all.load > 0 && are_coupled(rig);
  return found;
}

}  // namespace

Findings work(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    if (logs.survey(part).phase != Phase::moving || !plan.has_for_all(Channel::tau)) continue;
    const Channel channel = plan.has_for_all(Channel::theta) ? Channel::theta : Channel::q;
    if (!plan.has_for_all(channel)) continue;
    const Eigen::Index n = closed_blocks(part, channel);
    if (n < kFewBlocksOfWork) continue;
    const Braking braking = braking_joint(part, channel, n, plan.rig);
    if (braking.joint < 0) continue;
    const std::string tau = weighed_name(plan, Channel::tau, braking.joint);
    findings.push_back(
        {part.log,
         {},
         !braking.may_be_moved,
         fmt::format("{0} brakes: over a closed motion it does {1:.3g} J of work, of {2:.3g} J "
                     "exchanged; {3}the sign of {0} is reversed against the positions",
                     tau, braking.work.drive, braking.work.exchanged,
                     braking.may_be_moved ? "other joints move this one, or " : ""),
         braking.may_be_moved ? "check a log in which this joint moves alone"
                              : mending_line(plan, Channel::tau, braking.joint, -1)});
  }
  return findings;
}

}  // namespace cablefit::weighing
