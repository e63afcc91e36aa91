#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "cablefit/samples/weigh/checks.hpp"

namespace cablefit::weighing {
namespace {

constexpr double kSlowest = 5, kFastest = 1e5;      // samples per second of any motion log
constexpr double kSlowCrawl = 2;                    // of a slow motion that was over within kCrawl
constexpr double kCrawl = 1800;                     // s
constexpr double kNeverFaster = 1e6;                // nobody samples a joint at this
constexpr double kSlowestPositions = 0.01;          // without torque a log may be way-points
constexpr double kLongest = 31 * 86400.0;           // s
constexpr double kUsualLow = 20, kUsualHigh = 3e4;  // what a unit's correction should lead to

struct TimeUnit {
  std::string_view name;
  double seconds;
};
constexpr std::array<TimeUnit, 3> kTimeUnits = {{{"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};

/// The unit that makes the clock a usual one; empty when none does.
std::string_view likely_unit(const LogPlan& plan, double rate) {
  for (const TimeUnit& unit : kTimeUnits) {
    const double corrected = rate * plan.time_factor / unit.seconds;
    if (corrected >= kUsualLow && corrected <= kUsualHigh) return unit.name;
  }
  const double corrected = rate * plan.time_factor;
  return corrected >= kUsualLow && corrected <= kUsualHigh ? "s" : "";
}

std::string time_remedy(const LogPlan& plan, double rate) {
  if (!plan.time_column) return "correct the sample rate";
  const std::string_view unit = likely_unit(plan, rate);
  if (unit.empty()) return "check the time column and its unit";
  // Steps of 1 as written are milliseconds or numbers of rows.
  const bool counts_rows = rate * plan.time_factor == 1;
  return fmt::format(
      "is {0} in {1}? write \"t\": {{\"column\": \"{0}\", \"unit\": \"{1}\"}} in the rig "
      "file's columns{2}",
      plan.header.columns[*plan.time_column].name, unit,
      counts_rows ? "; does it count rows? --rate HZ" : "");
}

}  // namespace

Findings clock(const Logs& logs) {
  Findings findings;
  for (std::size_t l = 0; l < logs.logs.size(); ++l) {
    const LogPlan& plan = logs.logs[l].plan;
    for (const PartSurvey& part : logs.logs[l].parts) {
      const double rate = 1 / part.period, duration = part.t_last - part.t_first;
      const double slowest = !plan.has(Channel::tau) ? kSlowestPositions
                             : duration < kCrawl     ? kSlowCrawl
                                                     : kSlowest;
      std::string what;
      if (rate < slowest || rate > kFastest)
        what = fmt::format(
            "the time step is {:.3g} s, a rate of {:.3g} Hz; 5 Hz to 100 kHz is "
            "usual",
            part.period, rate);
      else if (duration > kLongest)
        what = fmt::format("the log lasts {:.3g} s, {:.0f} days", duration, duration / 86400);
      if (what.empty()) continue;
      const bool hopeless = rate < std::min(slowest, kSlowCrawl) || rate > kNeverFaster;
      findings.push_back({l, {}, true, what, time_remedy(plan, rate), hopeless});
      break;
    }
  }
  return findings;
}

}  // namespace cablefit::weighing
