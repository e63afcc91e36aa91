#include "cablefit/refine/rows/variant_grid.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/parameter.hpp"

namespace cablefit {
namespace {

constexpr double kEventMargin = 1.0;  // s, to the ends of a log
constexpr double kBeforeLog = 0;      // s, when the event happened between this log and the last

/// Every combination of the grid's values.
std::vector<std::vector<double>> grid_points(const Effect& row, const LogScale& scale) {
  std::vector<std::vector<double>> points = {{}};
  for (const ShapeGrid& grid : row.shape) {
    std::vector<std::vector<double>> more;
    for (const auto& point : points)
      for (int i = 0; i < grid.n_values; ++i) {
        more.push_back(point);
        more.back().push_back(grid.value(i, scale));
      }
    points = std::move(more);
  }
  return points;
}

double seconds_of(const Stretch& stretch) {
  return static_cast<double>(stretch.recording.theta.size()) * stretch.recording.period;
}

/// Dates at which an event may have happened: inside the moving logs, and of what blocked logs show
/// as well, as an axis that was homed anew, between two logs.
std::vector<std::pair<std::size_t, double>> dates(const Effect& row, const Design& design,
                                                  double step) {
  std::vector<std::pair<std::size_t, double>> all;
  std::size_t log = design.stretches.front().log;
  for (const Stretch& stretch : design.stretches) {
    if (row.is_static && stretch.log != log) all.emplace_back(stretch.log, kBeforeLog);
    log = stretch.log;
    if (stretch.blocked) continue;
    for (double t = kEventMargin; t < seconds_of(stretch) - kEventMargin; t += step)
      all.emplace_back(stretch.log, stretch.t0 + t);
  }
  return all;
}

/// What lasts changes all rows after it, so that its date is known from far; what passes does not,
/// and is missed between two dates that are further apart than it is long.
double date_step(const Effect& row, const std::vector<double>& shape, double event_step) {
  constexpr double kCoarser = 4, kOverlap = 0.75;
  return row.lasts() ? kCoarser * event_step : std::min(event_step, kOverlap * shape.front());
}

}  // namespace

std::vector<Variant> variants_of(const Effect& row, const Design& design, double event_step) {
  std::vector<Variant> all;
  for (const auto& shape : grid_points(row, design.scale)) {
    if (!row.is_event) {
      all.push_back({&row, shape, 0, 0, false});
      continue;
    }
    const double step = date_step(row, shape, event_step);
    for (const auto& [log, time] : dates(row, design, step)) {
      all.push_back({&row, shape, log, time, false});
      if (!row.lasts() || log == design.stretches.back().log) continue;
      all.push_back(all.back());
      all.back().ends_with_log = true;
    }
  }
  return all;
}

std::optional<Variant> plain_of(Variant variant) {
  const Effect& row = *variant.effect;
  if (!has_plain_form(row)) return {};
  variant.is_plain = true;
  if (replaces_rows(variant)) return {};  // no columns of its own
  for (std::size_t i = 0; i < row.shape.size(); ++i)
    if (!is_free(variant, i) && row.shape[i].canonical > 0 &&
        variant.shape[i] != row.shape[i].canonical)
      return {};
  return variant;
}

Variant other_form(Variant variant) {
  const Effect& row = *variant.effect;
  variant.is_plain = !variant.is_plain;
  for (std::size_t i = 0; variant.is_plain && i < row.shape.size(); ++i)
    if (row.shape[i].canonical > 0) variant.shape[i] = row.shape[i].canonical;
  return variant;
}

Variant with_shape(Variant variant, std::size_t shape, double value) {
  if (variant.effect->passes() && shape == 0)
    variant.event_time += (variant.shape[shape] - value) / 2;
  variant.shape[shape] = value;
  return variant;
}

std::pair<double, double> around(const ShapeGrid& grid, double value, const LogScale& scale) {
  const double low = grid.lowest(scale), end = grid.grid_end(scale), high = grid.highest(scale);
  if (grid.n_values < 2) return {low, high};
  if (grid.is_geometric) {
    const double step = std::pow(end / low, 1.0 / (grid.n_values - 1));
    return {std::max(low, value / step), std::min(high, value * step)};
  }
  const double step = (end - low) / (grid.n_values - 1);
  return {std::max(low, value - step), std::min(high, value + step)};
}

std::pair<double, double> dates_around(const Design& design, const Variant& variant,
                                       double event_step) {
  if (variant.event_time == kBeforeLog) return {kBeforeLog, kBeforeLog};
  const double step = date_step(*variant.effect, variant.shape, event_step);
  double low = kUnbounded, high = -kUnbounded;
  for (const Stretch& stretch : design.stretches) {
    if (stretch.log != variant.event_log) continue;
    low = std::min(low, stretch.t0 + kEventMargin);
    high = std::max(high, stretch.t0 + seconds_of(stretch) - kEventMargin);
  }
  return {std::max(low, variant.event_time - step), std::min(high, variant.event_time + step)};
}

}  // namespace cablefit
