#include <fmt/format.h>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kSaturated = 0.01;  // share of the samples at the limits of tau

}  // namespace

Findings saturation(const Logs& logs) {
  Findings findings;
  for (std::size_t l = 0; l < logs.logs.size(); ++l) {
    const LogSurvey& log = logs.logs[l];
    for (const PartSurvey& part : log.parts)
      for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
        const Slot& slot = log.plan.slots[k];
        if (slot.channel != Channel::tau || part.channels[k].at_limits <= kSaturated) continue;
        findings.push_back(
            {l,
             {},
             false,
             fmt::format("{} is at its limits in {:.1f} % of the samples: saturation?",
                         weighed_name(log.plan, slot.channel, slot.joint),
                         100 * part.channels[k].at_limits),
             "clipped torque biases every parameter: record with less torque, or log the "
             "actual torque of the drive"});
      }
  }
  return findings;
}

}  // namespace cablefit::weighing
