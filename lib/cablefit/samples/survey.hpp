// First look at a log: its parts (preload, phase, run), their clock, and per channel the range,
// quantum and noise. One pass in constant memory; everything later passes decide rests on it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/channels.hpp"

namespace cablefit {

enum class Phase { blocked, moving };
std::string_view to_string(Phase phase);

/// What one channel looks like within one part. SI.
struct ChannelSurvey {
  double min = 0, max = 0;
  double quantum = 0;    ///< smallest step between neighbours that occurs, 0 for a constant
  double noise = 0;      ///< sd of white noise, from sixth differences (they remove smooth motion)
  double at_limits = 0;  ///< share of rows exactly at min or max: saturation when large
  double range() const { return max - min; }
};

/// Rows of one log that belong together: same preload, phase and run.
struct PartSurvey {
  std::string preload, run;
  Phase phase = Phase::moving;
  bool phase_given = false;  ///< by a column, not by whether q stands still
  std::size_t n_rows = 0;
  std::size_t n_gaps = 0;  ///< jumps in time; nothing is differenced across them
  double t_first = 0, t_last = 0;
  double period = 0;                    ///< s, mean time between rows outside gaps
  double jitter = 0;                    ///< sd of the time between rows / period
  double worst_jitter = 0;              ///< largest deviation from the period / period
  bool uneven = false;                  ///< has to be resampled to an even grid
  std::vector<ChannelSurvey> channels;  ///< as LogPlan::slots
};

struct LogSurvey {
  LogPlan plan;
  std::string sha256;
  std::string default_preload;  ///< of rows without a preload of their own
  std::size_t n_rows = 0;
  std::vector<PartSurvey> parts;
};

/// Reads the whole log once. Throws Error(input) at file:line:column for time that stands still or
/// runs back, an unknown phase, and a part with fewer than 8 rows.
/// `preload`: name for parts without a preload column (the rig's, or an option); empty: "default".
LogSurvey survey_log(const LogPlan& plan, const std::string& preload);

/// Names of the preloads of the parts for which `wanted` says true, in the order in which they
/// come.
std::vector<std::string> preload_names(std::span<const LogSurvey> logs,
                                       const std::function<bool(const PartSurvey&)>& wanted);

/// The first log with a part for which `wanted` says true; the first one of all when there is none.
const LogSurvey& first_log_with(std::span<const LogSurvey> logs,
                                const std::function<bool(const PartSurvey&)>& wanted);

/// Follows preload/phase/run from row to row; used by every pass alike.
class PartTracker {
 public:
  PartTracker(const LogPlan& plan, std::string default_preload);
  /// Columns to select in the reader: numeric (time first when there is one), then text.
  std::vector<std::size_t> numeric_columns() const;
  std::vector<std::size_t> text_columns() const;
  struct Key {
    std::string preload, phase, run;
    bool operator==(const Key&) const = default;
  };
  /// Key of row i of the chunk; valid until the next call. `changed`: differs from the row before.
  const Key& key(const LogReader& reader, const LogChunk& chunk, std::size_t row, bool& changed);

 private:
  const LogPlan& plan_;
  std::string default_preload_;
  std::vector<std::size_t> texts_;
  std::vector<std::uint32_t> current_;
  Key key_;
  bool started_ = false;
};

/// Time of row i of a chunk in s, by the time column or the sample rate.
double time_of(const LogPlan& plan, const LogChunk& chunk, std::size_t row);

/// Longest step, in periods, that is still no gap.
double gap_factor(bool uneven);

}  // namespace cablefit
