// Survey of a log: its parts (preload, phase, run), the clock of each, and per channel the range,
// quantum and noise. It is one pass in constant memory, which also stores the samples in SI for all
// later passes.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/samples/plan/channels.hpp"
#include "cablefit/samples/survey/channel_scan.hpp"
#include "cablefit/samples/survey/clock_scan.hpp"
#include "cablefit/samples/survey/sample_store.hpp"

namespace cablefit {

/// Of a part, and of a stretch of it: fewer do not show a motion.
inline constexpr std::size_t kFewestRows = 8;

enum class Phase { blocked, moving };
std::string_view to_string(Phase phase);

/// Rows of one log that belong together: same preload, phase and run.
struct PartSurvey : ClockSurvey {
  std::string preload, run;
  Phase phase = Phase::moving;
  bool phase_given = false;  ///< a column gives the phase; otherwise the motion of q decides
  std::vector<ChannelSurvey> channels;  ///< as LogPlan::slots
};

struct LogSurvey {
  // Compiled once in survey.cpp, not in every file that copies or destroys one.
  LogSurvey();
  LogSurvey(const LogSurvey&);
  LogSurvey(LogSurvey&&) noexcept;
  LogSurvey& operator=(const LogSurvey&);
  LogSurvey& operator=(LogSurvey&&) noexcept;
  ~LogSurvey();

  LogPlan plan;
  std::string sha256;
  std::size_t n_rows = 0;
  std::vector<PartSurvey> parts;
  std::shared_ptr<const SampleStore> samples;  ///< the source of all later passes
  /// From LogPlan::trusted, rows left out or filled, and weigh_logs(); reported before other
  /// warnings.
  std::vector<std::string> warnings = {};
  /// Units, signs or samples that cannot be right but are trusted. They explain later warnings.
  bool has_trusted_finding = false;
};

/// Reads the whole log on up to `threads` threads; no later pass reads its text. Throws
/// Error(input) at file:line:column for time that does not advance, an unknown phase, and a part
/// with fewer than 8 rows. Also when more than half of the rows are left out for missing cells or a
/// fifth for repeated times, and in a moving log for LogPlan::absent. `preload`: name for parts
/// without a preload column (the rig's, or an option); empty: "default".
LogSurvey survey_log(const LogPlan& plan, const std::string& preload, int threads = 1);

/// blocked: the range of q is below 2 % of that of theta, for every joint.
Phase phase_by_motion(const PartSurvey& part, const LogPlan& plan);

/// Names of the preloads of the parts for which `wanted` is true, in the order in which they occur.
std::vector<std::string> preload_names(std::span<const LogSurvey> logs,
                                       const std::function<bool(const PartSurvey&)>& wanted);

/// The first log with a part for which `wanted` is true, else the first log.
const LogSurvey& first_log_with(std::span<const LogSurvey> logs,
                                const std::function<bool(const PartSurvey&)>& wanted);

/// Lowest and highest value of a channel in the parts for which `wanted` is true. low > high when
/// no such log has the channel.
struct ChannelRange {
  double low = kUnbounded, high = -kUnbounded;
  double width() const { return high - low; }
  double middle() const { return (low + high) / 2; }
};
ChannelRange seen_range(std::span<const LogSurvey> logs,
                        const std::function<bool(const PartSurvey&)>& wanted, Channel channel,
                        int joint = 0);

}  // namespace cablefit
