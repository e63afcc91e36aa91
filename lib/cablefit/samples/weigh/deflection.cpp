#include <fmt/format.h>

#include <cmath>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kAgainstDeflection = -0.8;  // correlation
constexpr double kOneSine = 0.95;            // correlation of a position and its acceleration
constexpr Eigen::Index kFewDeflections = 20;

}  // namespace

/// The motor pulls the link: tau grows with theta - q. Of exchanged positions it falls.
Findings deflection(const Logs& logs) {
  Findings findings;
  for (const CoarsePart& part : logs.parts) {
    const LogPlan& plan = logs.plan(part);
    const bool one_joint = plan.rig.n_joints() == 1 && !plan.rig.cables_given;
    const CoarsePart::Joint& joint = part.joints.front();
    if (!one_joint || logs.survey(part).phase != Phase::moving) continue;
    if (!plan.has_measured(Channel::q) || !plan.has_measured(Channel::theta)) continue;
    if (joint.tau.size() < kFewDeflections) continue;
    const double correlation = coarse_line(joint.theta - joint.q, joint.tau).correlation;
    if (correlation > kAgainstDeflection) continue;
    // Above its resonance a link swings against the drive.
    if (std::abs(
            coarse_line(at_inner(part, joint.q), coarse_rates(part, joint.q).second).correlation) >
        kOneSine)
      continue;
    findings.push_back({part.log,
                        {},
                        true,
                        fmt::format("tau falls as theta - q grows (correlation {:.2f}): are q and "
                                    "theta swapped?",
                                    correlation),
                        "exchange their columns in the rig file"});
  }
  return findings;
}

}  // namespace cablefit::weighing
