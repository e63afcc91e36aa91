#include "cablefit/dynamic/checks/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/dynamic/rows/scaled_settings.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kFactors[] = {0.5, 0.71, 1, 1.41, 2};
constexpr double kFlat = 2;  // sd, between any two points: fits of other rows scatter by one or so
constexpr const char* kCutoff = "cut-off";
constexpr const char* kRestSpeed = "rest speed";
constexpr const char* kRestMargin = "rest margin";

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

/// " (3.1 %)"; nothing of a value of 0.
std::string share_text(double share) {
  return std::isfinite(share) ? fmt::format(" ({:.2g} %)", 100 * share) : "";
}

/// How far each parameter moves over a setting, against its sd: an error that a setting makes and
/// no interval holds.
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
    const double range = high - low;
    largest = std::max(largest, range);
    if (!(range > kFlat)) continue;
    moved += fmt::format("{}{} moves by {:.1f} sd{}", moved.empty() ? "" : ", ",
                         sweep.parameters[k], range, share_text(range * sweep.relative_sd[k]));
    verdict.is_flat = false;
  }
  verdict.text =
      fmt::format("{} between {} and {} {}",
                  moved.empty() ? fmt::format("flat: all changes below {:.1f} sd", largest) : moved,
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
  const RowSettings& rows = job.settings.rows;
  const double cutoff = rows.signal.cutoff;
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  const std::string length = unit_for(job.rig().axes.all(), "rad/s");
  const auto add = [&](const char* setting, double chosen, const std::string& unit, auto scaled,
                       double most) {
    if (!(chosen > 0)) return;
    for (const double factor : kFactors)
      if (factor <= 1 || factor * chosen <= most)
        sweep.points.push_back({setting, factor, factor * chosen,
                                factor == 1 ? std::vector<double>(sweep.parameters.size(), 0.0)
                                            : changes(scaled(job, factor), estimator, model, fit)});
    sweep.verdicts.push_back(judged(sweep, setting, unit));
  };
  add(kCutoff, cutoff, "Hz", with_cutoff_scaled, kMostShareOfRate * rate);
  add(kRestSpeed, job.settings.rest_speed_theta, length, with_rest_speed_scaled, kUnbounded);
  add(kRestMargin, static_cast<double>(rows.rest_margin) / rate, "s", with_rest_margin_scaled,
      kUnbounded);
  return sweep;
}

}  // namespace cablefit
