// Which clock a log goes by.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cablefit/base/quote.hpp"
#include "cablefit/samples/plan/plan_parts.hpp"

namespace cablefit::plan_parts {
namespace {

// A column with a rate in this range, Hz, is a clock; one of 1 Hz counts rows.
constexpr double kSlowestClock = 5, kFastestClock = 100'000;
constexpr double kRateAgrees = 0.01;  // relative
constexpr std::size_t kClockRows = 20'000;
constexpr double kDriftRows = 10;  // rows that a burst may be late
constexpr double kRounding = 1.5;  // steps of a time with few digits

/// The rate of rows that a user, the rig file or the log gives; 0: none of them.
struct GivenRate {
  double rate = 0;  ///< Hz
  std::string who, remedy;
  bool replaces_clock = false;  ///< stands for the log's time column too
};
GivenRate given_rate(const LogPlan& plan) {
  if (plan.reading.rate > 0)
    return {plan.reading.rate, "the rate given is", "leave --rate out, or correct it", true};
  if (plan.rig.sample_rate > 0)
    return {plan.rig.sample_rate, "\"sample_rate\" in the rig file is",
            "leave it out, or correct it", false};
  return {plan.header.sample_rate.value_or(0), "\"sample_rate\" of the log is",
          "correct the one that is wrong", false};
}

/// The time of the first rows of a log.
struct ClockLook {
  std::vector<double> t, steps;

  void add(double time) {
    if (!std::isfinite(time)) return;
    if (!t.empty()) steps.push_back(time - t.back());
    t.push_back(time);
  }
  /// Hz, of the usual step: gaps do not count. A time with few digits mostly stands still; then of
  /// the mean step.
  double rate() const {
    if (steps.empty()) return 0;
    std::vector<double> sorted = steps;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (*middle > 0) return 1 / *middle;
    const double duration = t.back() - t.front();
    return duration > 0 ? static_cast<double>(steps.size()) / duration : 0;
  }
  double smallest_step() const {
    double smallest = kUnbounded;
    for (const double step : steps)
      if (step > 0) smallest = std::min(smallest, step);
    return smallest;
  }
  /// Largest deviation from rows at that rate, s.
  double drift(double rate) const {
    double largest = 0;
    for (std::size_t i = 0; i < t.size(); ++i)
      largest = std::max(largest, std::abs(t[i] - t[0] - static_cast<double>(i) / rate));
    return largest;
  }
};

ClockLook look_at_clock(const LogPlan& plan, std::size_t column, double factor) {
  ClockLook look;
  LogText text = plan.reading.text();
  text.may_miss = true;
  try {
    const auto reader = open_log(plan.path, text);
    reader->select({column}, {});
    LogChunk chunk;
    while (look.t.size() < kClockRows && reader->next(chunk))
      for (const double t : chunk.numbers.front()) look.add(t * factor);
  } catch (const Error&) {
    return {};  // no numbers: no clock
  }
  return look;
}

/// Where a log has a clock and a rate is given as well, they must agree: one of them is wrong.
void require_one_rate(LogPlan& plan, std::size_t column, double factor, const GivenRate& given) {
  const ClockLook look = look_at_clock(plan, column, factor);
  const double rate = look.rate();
  if (!(rate >= kSlowestClock && rate <= kFastestClock)) return;
  const double resolution = kDriftRows / given.rate + kRounding * look.smallest_step();
  const bool drifts = look.drift(given.rate) > resolution;
  if (!drifts) return;
  const ColumnHeader& cell = plan.header.columns[column];
  const bool agrees = std::abs(rate / given.rate - 1) <= kRateAgrees;
  if (agrees && !given.replaces_clock) return;  // gaps, which the clock that is read shows
  const std::string what =
      agrees ? fmt::format("column {} has gaps or drifts; rows at {:.4g} Hz would hide them",
                           in_quotes(cell.name), given.rate)
             : fmt::format("column {} has {:.4g} Hz, {} {:.4g} Hz", in_quotes(cell.name), rate,
                           given.who, given.rate);
  refuse_untrusted(plan, input_error(cell.place, what, given.remedy));
}

/// Of a time column that is not read: 0 where its unit is none of time.
double factor_of_replaced(const LogPlan& plan, const ColumnHeader& cell) {
  const ColumnMapping mapping = mapping_of(plan.rig, "t");
  if (cell.is_date) return 1;
  try {
    const Unit unit =
        parse_unit(mapping.unit.empty() ? written_unit(cell, kTime).unit : mapping.unit);
    const bool is_time = unit.dimension == kTime || unit.dimension == kNumber;
    return is_time ? unit.scale * mapping.scale : 0;
  } catch (const Error&) {
    return 0;
  }
}

/// A rate that somebody gives for this log stands for its time column too.
void replace_time(LogPlan& plan, const GivenRate& given) {
  const std::size_t column = *plan.time_column;
  const ColumnHeader& cell = plan.header.columns[column];
  require_one_rate(plan, column, factor_of_replaced(plan, cell), given);
  plan.decisions.push_back(
      {"clock", fmt::format("{:g} Hz", plan.sample_rate), "given; column 't' is not read"});
  plan.time_column.reset();
}

void require_rate(const LogPlan& plan) {
  if (plan.sample_rate > 0) return;
  throw input_error(
      {plan.path, header_line(plan.header), 0}, "no column 't' and no sample rate",
      fmt::format(
          "name the time column 't' or map it in a rig file ('cablefit init' writes one), or "
          "give the rate by --rate HZ or \"sample_rate\" in the rig file; columns are {}",
          names_of(plan.header)));
}

void resolve_time_unit(LogPlan& plan) {
  const ColumnHeader& cell = plan.header.columns[*plan.time_column];
  if (cell.is_date) return;
  const ColumnMapping mapping = mapping_of(plan.rig, "t");
  const std::string unit = unit_of(plan, cell, mapping, kTime);
  if (!unit.empty())
    plan.time_factor = checked_unit(unit, cell.place, kTime, "column 't'", "a time").scale;
  plan.time_factor *= mapping.scale;
}

}  // namespace

void resolve_time(LogPlan& plan) {
  const GivenRate given = given_rate(plan);
  plan.time_column = column_of(plan.header, plan.rig, "t", kTime);
  plan.sample_rate = given.rate;
  if (given.replaces_clock && plan.time_column) replace_time(plan, given);
  if (!plan.time_column) {
    require_rate(plan);
    return;
  }
  resolve_time_unit(plan);
  if (given.rate > 0) require_one_rate(plan, *plan.time_column, plan.time_factor, given);
}

}  // namespace cablefit::plan_parts
