#include "cablefit/dynamic/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kFactors[] = {0.5, 0.71, 1, 1.41, 2};
constexpr double kMostShareOfRate = 0.3;  // of a cut-off: above it differences are off by percents
constexpr double kFlat = 2;               // sd
constexpr double kSmall = 0.01;           // of a parameter: certain, but it does not matter
constexpr const char* kCutoff = "cut-off";
constexpr const char* kRestSpeed = "rest speed";

void scale_cutoff(ChosenSettings& settings, double factor) {
  RowSettings& rows = settings.rows;
  const auto divided = [factor](auto n) {
    return static_cast<decltype(n)>(std::lround(static_cast<double>(n) / factor));
  };
  rows.signal.cutoff *= factor;
  rows.lowest_cutoff *= factor;
  settings.cutoff_q *= factor;
  rows.decimate = std::max(1, divided(rows.decimate));
  rows.drop_edge = std::max(kDifferenceEdge, divided(rows.drop_edge));
  rows.rest_margin = divided(rows.rest_margin);
}

void scale_rest_speed(ChosenSettings& settings, double factor) {
  settings.rest_speed_theta *= factor;
  settings.rest_speed_q *= factor;
}

DynamicJob with_settings(const DynamicJob& job, void (*scale)(ChosenSettings&, double),
                         double factor) {
  DynamicJob other = job;
  scale(other.settings, factor);
  for (ChosenSettings& joint : other.joint_settings) scale(joint, factor);
  return other;
}

/// Per parameter of `fit` its change in sd.
std::vector<double> changes(const DynamicJob& job, const Estimator& estimator, std::size_t model,
                            const DynamicFit& fit) {
  std::vector<EquationRows> equations = make_equations(job);
  collect_rows(job, equations);
  const DynamicFit other = estimator.estimate({job, equations, model}).fit;
  std::vector<double> out;
  for (const Estimate& e : fit.parameters) {
    const Estimate* same = find_estimate(other.parameters, e.name);
    const bool both =
        same != nullptr && same->not_identifiable.empty() && e.not_identifiable.empty() && e.sd > 0;
    out.push_back(both ? (same->value - e.value) / e.sd : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

std::string value_text(const SweepPoint& point) { return fmt::format("{:.3g}", point.value); }

SweepVerdict judged(const Sweep& sweep, const std::string& setting, const std::string& unit) {
  std::vector<const SweepPoint*> points;
  for (const SweepPoint& point : sweep.points)
    if (point.setting == setting) points.push_back(&point);
  SweepVerdict verdict{setting, "", true};
  std::string moved;
  double largest = 0;
  for (std::size_t k = 0; k < sweep.parameters.size(); ++k) {
    double low = 0, high = 0;
    for (const SweepPoint* point : points)
      if (std::isfinite(point->change[k])) {
        low = std::min(low, point->change[k]);
        high = std::max(high, point->change[k]);
      }
    largest = std::max(largest, high - low);
    if (!(high - low > kFlat)) continue;
    const double relative = (high - low) * sweep.relative_sd[k];
    moved += fmt::format("{}{} moves by {:.1f} sd ({:.2g} %)", moved.empty() ? "" : ", ",
                         sweep.parameters[k], high - low, 100 * relative);
    verdict.is_flat = verdict.is_flat && relative < kSmall;
  }
  if (verdict.is_flat && !moved.empty()) moved = "flat within 1 %: " + moved;
  verdict.text = fmt::format(
      "{} between {} and {} {}",
      moved.empty() ? fmt::format("flat: no parameter moves by more than {:.1f} sd", largest)
                    : moved,
      value_text(*points.front()), value_text(*points.back()), unit);
  return verdict;
}

}  // namespace

Sweep sweep_settings(const DynamicJob& job, const Estimator& estimator, std::size_t model,
                     const DynamicFit& fit) {
  Sweep sweep;
  for (const Estimate& e : fit.parameters) {
    sweep.parameters.push_back(e.name);
    sweep.relative_sd.push_back(e.value != 0 ? std::abs(e.sd / e.value) : 0);
  }
  const double cutoff = job.settings.rows.signal.cutoff;
  const double rest = job.settings.rest_speed_theta;
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  const auto add = [&](const char* setting, double factor, double value, auto scale) {
    const DynamicJob other = with_settings(job, scale, factor);
    sweep.points.push_back({setting, factor, value,
                            factor == 1 ? std::vector<double>(sweep.parameters.size(), 0.0)
                                        : changes(other, estimator, model, fit)});
  };
  for (const double factor : kFactors)
    if (cutoff > 0 && (factor <= 1 || factor * cutoff <= kMostShareOfRate * rate))
      add(kCutoff, factor, factor * cutoff, scale_cutoff);
  for (const double factor : kFactors)
    if (rest > 0) add(kRestSpeed, factor, factor * rest, scale_rest_speed);
  const std::string length = job.rig().linear_motion ? "m/s" : "rad/s";
  if (cutoff > 0) sweep.verdicts.push_back(judged(sweep, kCutoff, "Hz"));
  if (rest > 0) sweep.verdicts.push_back(judged(sweep, kRestSpeed, length));
  return sweep;
}

}  // namespace cablefit
