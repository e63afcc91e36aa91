// Which clock a log goes by.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/quote.hpp"
#include "cablefit/samples/plan_parts.hpp"

namespace cablefit::plan_parts {
namespace {

// A column with a rate in this range, Hz, is a clock; one of 1 Hz counts rows.
constexpr double kSlowestClock = 5, kFastestClock = 100'000;
constexpr double kRateAgrees = 0.01;  // relative
constexpr std::size_t kClockRows = 20'000;

/// The rate of rows that a user, the rig file or the log gives; 0: none of them.
struct GivenRate {
  double rate = 0;  ///< Hz
  std::string who, remedy;
  bool replaces_clock = false;  ///< stands for the log's time column too
};
GivenRate given_rate(const LogPlan& plan) {
  if (plan.reading.rate > 0)
    return {plan.reading.rate, "the rate given is", "leave --rate out, or take the right one",
            true};
  if (plan.rig.sample_rate > 0)
    return {plan.rig.sample_rate, "\"sample_rate\" in the rig file is",
            "leave it out, or take the right one", true};
  return {plan.header.sample_rate.value_or(0), "\"sample_rate\" of the log is",
          "correct the one that is wrong", false};
}

/// The steps of a time column between the first rows of a log, backward ones left out.
struct ClockSteps {
  double sum = 0, largest = 0, last = 0;  // last: the time of the row before
  std::size_t n_rows = 0, n_steps = 0;

  void add(double t) {
    if (!std::isfinite(t)) return;
    if (n_rows > 0 && t >= last) {
      sum += t - last;
      largest = std::max(largest, t - last);
      ++n_steps;
    }
    last = t;
    ++n_rows;
  }
  double rate() const { return sum > 0 ? static_cast<double>(n_steps) / sum : 0; }
  /// Relative; a time with few digits stands still between its steps.
  double uncertainty() const { return largest / sum; }
};

ClockSteps clock_steps(const LogPlan& plan, std::size_t column, double factor) {
  ClockSteps steps;
  LogText text = plan.reading.text();
  text.may_miss = true;
  try {
    const auto reader = open_log(plan.path, text);
    reader->select({column}, {});
    LogChunk chunk;
    while (steps.n_rows < kClockRows && reader->next(chunk))
      for (const double t : chunk.numbers.front()) steps.add(t * factor);
  } catch (const Error&) {
    return {};  // no numbers: no clock
  }
  return steps;
}

/// Where a log has a clock and a rate is given as well, they must agree: one of them is wrong.
void require_one_rate(LogPlan& plan, std::size_t column, double factor, const GivenRate& given) {
  const ClockSteps steps = clock_steps(plan, column, factor);
  const double rate = steps.rate();
  if (!(rate >= kSlowestClock && rate <= kFastestClock)) return;
  if (std::abs(rate / given.rate - 1) <= kRateAgrees + steps.uncertainty()) return;
  const ColumnHeader& cell = plan.header.columns[column];
  refuse_untrusted(
      plan, input_error(cell.place,
                        fmt::format("column {} has {:.4g} Hz, {} {:.4g} Hz",
                                    cablefit::quoted(cell.name), rate, given.who, given.rate),
                        given.remedy));
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
      {plan.path, 1, 0}, "no column 't' and no sample rate",
      fmt::format("name the time column 't' or map it in the rig file, or give the rate by "
                  "--rate HZ or \"sample_rate\" in the rig file; columns are {}",
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
