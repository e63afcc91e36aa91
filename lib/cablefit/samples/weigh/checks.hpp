// The checks a log is weighed by, one file each; a row of the table in weigh.cpp calls them.
#pragma once

#include <span>
#include <vector>

#include "cablefit/samples/weigh/coarse_rows.hpp"
#include "cablefit/samples/weigh/finding.hpp"

namespace cablefit::weighing {

struct Logs {
  std::span<const LogSurvey> logs;
  std::span<const CoarsePart> parts;  ///< empty for checks of the clock and of single samples

  const LogPlan& plan(const CoarsePart& part) const { return logs[part.log].plan; }
  const PartSurvey& survey(const CoarsePart& part) const { return logs[part.log].parts[part.part]; }
};
using Findings = std::vector<Finding>;

Findings clock(const Logs& logs);            ///< rate 5 Hz to 100 kHz, duration under a month
Findings spikes(const Logs& logs);           ///< lone samples far beyond all others
Findings jumps(const Logs& logs);            ///< positions that leap from one sample to the next
Findings swapped_joints(const Logs& logs);   ///< motors that follow the link of another joint
Findings positions(const Logs& logs);        ///< theta against q: sign, degrees, reduction, range
Findings velocity(const Logs& logs);         ///< w against the derivative of the position
Findings reference(const Logs& logs);        ///< theta_ref against theta
Findings blocked_slope(const Logs& logs);    ///< tau against theta while the link is blocked
Findings reversed_joints(const Logs& logs);  ///< signs of q, theta and tau of one joint
Findings work(const Logs& logs);             ///< the drive's work over a closed motion
Findings deflection(const Logs& logs);       ///< tau against theta - q
Findings load_balance(const Logs& logs);     ///< tau against the known load
Findings saturation(const Logs& logs);       ///< tau that stands at its limits
Findings duplicates(const Logs& logs);       ///< logs with the same samples, other digits or clock
Findings overlaps(const Logs& logs);         ///< logs with a stretch in common

}  // namespace cablefit::weighing
