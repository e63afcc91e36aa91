// Logs that go into one fit must agree: one rig, one kind of load.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

struct LogPart {
  const LogPlan* plan = nullptr;
  Phase phase = Phase::moving;
};

/// Whether parts may be of one fit: rig files of the same content, or equal but for a load that
/// each log has as a channel.
bool is_same_bench(const LogPart& a, const LogPart& b);

/// For the wanted parts, which are all of `preload`: rig files of the same content, or equal but
/// for a load that each log has as a channel (samples/load_channels.hpp), and a tau_load column
/// wherever the rig says that the load is one. Throws Error(input) naming the two logs.
void require_agreement(std::span<const LogSurvey> logs, const PartFilter& wanted,
                       const std::string& preload);

/// Warnings of logs with moving parts among the wanted that have neither a load law in the rig file
/// nor a tau_load column (of some joint).
std::vector<std::string> unloaded_warnings(std::span<const LogSurvey> logs,
                                           const PartFilter& wanted);

/// What is odd about the logs whatever they are used for: what weigh_logs() found, then columns of
/// further joints that a rig of one joint does not read.
std::vector<std::string> input_warnings(std::span<const LogSurvey> logs);

/// Some log with wanted parts has a unit, sign, column or sample that cannot be right, and is
/// accepted with --trust-units. It then explains a poor fit, and no second cause is reported.
bool has_trusted_finding(std::span<const LogSurvey> logs, const PartFilter& wanted);

/// Samples per second of the wanted parts. They may differ: the slowest log bounds the cut-off and
/// the decimation for all, the fastest decides how many rows a filter needs to settle.
struct RateRange {
  double lowest = 0, highest = 0;
};
RateRange sample_rates(std::span<const LogSurvey> logs, const PartFilter& wanted);

}  // namespace cablefit
