#include "cablefit/samples/survey/clock_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr double kGapEven = 1.5;  // an even clock: a missing row is a gap
constexpr double kGapUneven = 5;  // an uneven one: interpolate over a few missed rows, not more
constexpr double kUnevenJitter = 0.3;  // of the period; less is rounding of the printed time
constexpr double kUnevenShare = 0.01;  // of the steps off by that much; fewer are dropped rows

Error clock_error(double t, double step, const Place& place) {
  if (step == 0)
    return input_error(place, fmt::format("time does not advance at t = {:g} s", t),
                       "remove the duplicate row, or keep the first by --repeated first");
  return input_error(place, fmt::format("time goes back to t = {:g} s", t),
                     "sort the rows, or mark each run in a 'run' column");
}

}  // namespace

double gap_factor(bool uneven) { return uneven ? kGapUneven : kGapEven; }

void StepSums::add(const StepSums& others) {
  if (others.n == 0) return;
  low = n == 0 ? others.low : std::min(low, others.low);
  high = std::max(high, others.high);
  sum += others.sum;
  squares += others.squares;
  n += others.n;
}

void StepSums::add(double step) {
  if (step > longest) {
    ++n_gaps;
    return;
  }
  low = n == 0 ? step : std::min(low, step);
  high = std::max(high, step);
  sum += step;
  squares += step * step;
  ++n;
}

bool ClockScan::add(double t, bool continues, const std::string& path, std::uint64_t line) {
  bool jumped = !continues;
  if (n_rows_ == 0) first_ = t;
  if (continues) {
    const double step = t - last_;
    if (!(step > 0)) throw clock_error(t, step, {path, line, 0});
    // Until enough steps are known, the last one has to do as the scale.
    const double usual = median_ > 0 ? median_ : last_step_;
    jumped = usual > 0 && step > kGapEven * usual;
    last_step_ = step;
    add_step(step);
  }
  last_ = t;
  ++n_rows_;
  return jumped;
}

std::size_t ClockScan::add_usual(std::span<const double> t) {
  if (median_ == 0) return 0;
  StepSums even = even_;  // a copy stays in registers
  const double off = kUnevenJitter * median_;
  std::size_t n = 0, n_off = 0;
  double last = last_;
  for (; n < t.size(); ++n) {
    const double step = t[n] - last;
    if (!(step > 0 && step <= even_.longest)) break;
    even.add(step);
    n_off += std::abs(step - median_) > off;
    last = t[n];
  }
  even_ = even;
  last_ = last;
  n_off_ += n_off;
  n_steps_ += n;
  n_rows_ += n;
  return n;
}

ClockSurvey ClockScan::result() {
  if (n_steps_ < early_.size()) calibrate();
  ClockSurvey survey;
  survey.uneven = static_cast<double>(n_off_) > kUnevenShare * static_cast<double>(n_steps_);
  StepSums steps = even_;
  if (survey.uneven) {
    steps.add(longer_);
    steps.n_gaps = longer_.n_gaps;
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, steps.n));
  survey.n_rows = n_rows_;
  survey.t_first = first_;
  survey.t_last = last_;
  survey.period = steps.sum / n;
  survey.n_gaps = steps.n_gaps;
  if (!(survey.period > 0)) return survey;
  const double variance = steps.squares / n - survey.period * survey.period;
  survey.jitter = std::sqrt(std::max(0.0, variance)) / survey.period;
  survey.worst_jitter =
      std::max(steps.high - survey.period, survey.period - steps.low) / survey.period;
  return survey;
}

void ClockScan::add_step(double step) {
  if (n_steps_ < early_.size()) {
    early_[n_steps_++] = step;
    if (n_steps_ == early_.size()) calibrate();
    return;
  }
  ++n_steps_;
  count(step);
}

void ClockScan::calibrate() {
  if (n_steps_ == 0) return;
  std::array<double, 64> sorted = early_;
  const auto middle = sorted.begin() + static_cast<long>(n_steps_ / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<long>(n_steps_));
  median_ = *middle;
  even_.longest = kGapEven * median_;
  longer_.longest = kGapUneven * median_;
  for (std::size_t k = 0; k < n_steps_; ++k) count(early_[k]);
}

void ClockScan::count(double step) {
  even_.add(step);
  if (step > even_.longest) longer_.add(step);
  n_off_ += std::abs(step - median_) > kUnevenJitter * median_;
}

}  // namespace cablefit
