#include "cablefit/refine/scan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/base/parallel.hpp"
#include "cablefit/refine/elastic_stage.hpp"

namespace cablefit {
namespace {

// Of a candidate's columns, scaled: the squared part that the others leave. With less, a base that
// is off by a per cent passes for the effect.
constexpr double kTolerance = 1e-4;
constexpr double kEventMargin = 1.0;  // s, to the ends of a log
constexpr int kGoldenSteps = 9;       // 0.618^9 = 1 % of a cell

bool is_out_of_bounds(const Refinement& row, const Eigen::VectorXd& x, Eigen::Index first) {
  for (std::size_t p = 0; p < row.n_linear(); ++p) {
    const double value = x(first + static_cast<Eigen::Index>(p));
    if (value < row.parameters[p].lower || value > row.parameters[p].upper) return true;
  }
  return false;
}

std::optional<BlockGrams> grams_with(const ScanStart& start, const ScanSettings& settings,
                                     const Variant& variant) {
  const Design& design = start.design;
  if (replaces_rows(*variant.refinement)) {
    const auto rows = replaced_rows(design, variant);
    if (rows.empty()) return {};
    return block_grams(rows, design.stretches, settings.block_seconds);
  }
  return extended(start.grams, design.rows, design.stretches,
                  variant_columns(design, variant, start.fit.x), settings.block_seconds);
}

/// No candidate where the columns are not there or cannot be told from the others'.
std::optional<Candidate> try_variant(const ScanStart& start, const ScanSettings& settings,
                                     Variant variant) {
  const auto grams = grams_with(start, settings, variant);
  if (!grams) return {};
  const Refinement& row = *variant.refinement;
  const auto fit = fit_blocks(*grams, start.levels, !row.is_event,
                              {kTolerance, static_cast<Eigen::Index>(row.n_linear())});
  if (!fit) return {};
  Candidate c;
  c.variant = std::move(variant);
  c.x = fit->x;
  c.rms = fit->rms();
  c.error = row.is_event ? fit->in_sample : fit->held_out;
  const Eigen::ArrayXd& before = row.is_event ? start.fit.in_sample : start.fit.held_out;
  c.gain = 1 - c.error.sum() / before.sum();
  const Eigen::Index first = fit->x.size() - static_cast<Eigen::Index>(row.n_linear());
  if (is_out_of_bounds(row, fit->x, first)) c.refused = "beyond its physical bound";
  return c;
}

/// Every combination of the grid's values.
std::vector<std::vector<double>> grid_points(const Refinement& row, const LogScale& scale) {
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

/// Dates at which an event may have happened: inside the moving logs.
std::vector<std::pair<std::size_t, double>> dates(const Design& design, double step) {
  std::vector<std::pair<std::size_t, double>> all;
  for (const Stretch& stretch : design.stretches) {
    if (stretch.blocked) continue;
    const double seconds =
        static_cast<double>(stretch.recording.theta.size()) * stretch.recording.period;
    for (double t = kEventMargin; t < seconds - kEventMargin; t += step)
      all.emplace_back(stretch.log, stretch.t0 + t);
  }
  return all;
}

/// What lasts changes all rows after it, so that its date is known from far; what passes does not.
double date_step(const Refinement& row, const ScanSettings& settings) {
  constexpr double kCoarser = 4;
  return (row.lasts() ? kCoarser : 1.0) * settings.event_step;
}

std::vector<Variant> variants_of(const Refinement& row, const Design& design, double event_step) {
  std::vector<Variant> all;
  for (const auto& shape : grid_points(row, design.scale)) {
    if (!row.is_event) {
      all.push_back({&row, shape, 0, 0});
      continue;
    }
    for (const auto& [log, time] : dates(design, event_step))
      all.push_back({&row, shape, log, time});
  }
  return all;
}

/// A physical candidate before one that is not, then the larger gain.
bool is_better(const Candidate& a, const Candidate& b) {
  if (a.refused.empty() != b.refused.empty()) return a.refused.empty();
  return a.gain > b.gain;
}

std::optional<Candidate> best_variant(const ScanStart& start, const ScanSettings& settings,
                                      const Refinement& row) {
  std::optional<Candidate> best;
  for (Variant& variant : variants_of(row, start.design, date_step(row, settings))) {
    auto candidate = try_variant(start, settings, std::move(variant));
    if (candidate && (!best || is_better(*candidate, *best))) best = std::move(candidate);
  }
  return best;
}

/// Minimum of `error` over [low, high] by golden section (Kiefer 1953).
template <typename Error>
double golden(double low, double high, Error error) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = error(a), at_b = error(b);
  for (int i = 0; i < kGoldenSteps; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      at_a = error(a = high - ratio * (high - low));
    } else {
      low = a;
      a = b;
      at_a = at_b;
      at_b = error(b = low + ratio * (high - low));
    }
  }
  return at_a < at_b ? a : b;
}

/// A step of the grid to either side, as far as the grid goes.
std::pair<double, double> around(const ShapeGrid& grid, double value, const LogScale& scale) {
  const double low = grid.lowest(scale), high = grid.highest(scale);
  if (grid.n_values < 2) return {low, high};
  if (grid.is_geometric) {
    const double step = std::pow(high / low, 1.0 / (grid.n_values - 1));
    return {std::max(low, value / step), std::min(high, value * step)};
  }
  const double step = (high - low) / (grid.n_values - 1);
  return {std::max(low, value - step), std::min(high, value + step)};
}

}  // namespace

std::vector<Candidate> scan(const ScanStart& start, const ScanSettings& settings,
                            const std::vector<const Refinement*>& without) {
  std::vector<Candidate> found;
  ordered_pipeline<const Refinement*>(
      settings.threads,
      [&](auto emit) {
        for (const Refinement& row : refinements())
          if (is_candidate(row, start.design) &&
              std::find(without.begin(), without.end(), &row) == without.end())
            emit(static_cast<const Refinement*>(&row));
      },
      [&](const Refinement* row) { return best_variant(start, settings, *row); },
      [&](std::optional<Candidate> candidate) {
        if (candidate) found.push_back(std::move(*candidate));
      });
  return found;
}

Candidate refined_shape(const ScanStart& start, const ScanSettings& settings, Candidate candidate) {
  constexpr int kRounds = 2;
  const Refinement& row = *candidate.variant.refinement;
  const auto error_with = [&](const Variant& variant) {
    const auto tried = try_variant(start, settings, variant);
    return tried && tried->refused.empty() ? tried->error.sum() : kUnbounded;
  };
  Variant variant = candidate.variant;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < variant.shape.size(); ++i) {
      if (row.shape[i].is_whole) continue;
      const auto [low, high] = around(row.shape[i], variant.shape[i], start.design.scale);
      variant.shape[i] = golden(low, high, [&](double value) {
        Variant other = variant;
        other.shape[i] = value;
        return error_with(other);
      });
    }
    if (!row.is_event) continue;
    const double step = date_step(row, settings);
    variant.event_time =
        golden(variant.event_time - step, variant.event_time + step, [&](double time) {
          Variant other = variant;
          other.event_time = time;
          return error_with(other);
        });
  }
  const auto better = try_variant(start, settings, variant);
  return better && better->refused.empty() && better->gain >= candidate.gain ? *better : candidate;
}

}  // namespace cablefit
