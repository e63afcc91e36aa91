// Contradictions between a log's numbers and the units, signs and columns it is read with.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cablefit/samples/plan/channels.hpp"

namespace cablefit {

struct Finding {
  std::size_t log = 0;                  ///< index of the log it was found in
  std::optional<std::size_t> row = {};  ///< in the log as it is read; none: the whole log
  bool wrong = false;                   ///< cannot be right; else it is odd
  std::string what;                     ///< with its size
  std::string remedy;                   ///< the rig line that mends it, or what to do
  bool always_refused = false;  ///< even when units are trusted: the work would have no bound
  bool whole_rig = false;       ///< found in all logs of its rig together; else in this log alone
};

/// A measured factor, or the reduction it is within 1 % of: 0.05 for 0.0501, 5 for 5.002.
double nice_factor(double measured);

/// The line of a rig file that multiplies a channel by `factor`:
/// "theta": {"column": "motor", "scale": -1}.
std::string mending_line(const LogPlan& plan, Channel channel, int joint, double factor);

/// The same of a factor that was measured, with its relative error if that is known: the drawing or
/// the data sheet has the exact one. `what`: its name.
std::string measured_line(const LogPlan& plan, Channel channel, int joint, double factor,
                          std::optional<double> error, std::string_view what);

/// The same that names its unit: "theta": {"column": "motor", "unit": "deg"}.
std::string mending_unit(const LogPlan& plan, Channel channel, int joint, std::string_view unit);

/// The line of a row of the log, counted as its samples are; reads the log once more.
std::uint64_t line_of_row(const LogPlan& plan, std::size_t row);

/// "theta", or "theta2" on a rig of several joints.
std::string weighed_name(const LogPlan& plan, Channel channel, int joint);

}  // namespace cablefit
