#include "cablefit/refine/search/scan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "cablefit/base/parallel.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/rows/variant_grid.hpp"
#include "cablefit/refine/search/applicable.hpp"
#include "cablefit/refine/search/golden.hpp"
#include "cablefit/refine/search/order_spectrum.hpp"
#include "cablefit/refine/search/quick_look.hpp"

namespace cablefit {
namespace {

// Of a candidate's columns, scaled: the squared part that the others leave. With less, a base that
// is off by a per cent passes for the effect.
constexpr double kTolerance = 1e-4;
constexpr std::string_view kCompliance = "rad/(N m)";

/// `x`: of the variant's own columns.
bool is_out_of_bounds(const Effect& row, const Eigen::VectorXd& x) {
  for (Eigen::Index p = 0; p < x.size(); ++p) {
    const ParameterInfo& bounds = row.parameters[static_cast<std::size_t>(p)];
    if (x(p) < bounds.lower || x(p) > bounds.upper) return true;
  }
  return false;
}

/// rad/(N m), of the model's cables on average; 0: there are none.
double mean_compliance(const Design& design) {
  double sum = 0, n = 0;
  for (const std::vector<JointState>& states : design.states)
    for (const JointState& state : states) {
      sum += state.stiffness;
      n += 1;
    }
  return sum > 0 ? n / sum : 0;
}

/// What every function here needs.
struct Scanner {
  const ScanStart& start;
  const ScanSettings& settings;
  QuickLook look;
  double compliance;  ///< rad/(N m)
  Scanner(const ScanStart& from, const ScanSettings& how)
      : start(from),
        settings(how),
        look(from.design, from.grams, from.levels),
        compliance(mean_compliance(from.design)) {}

  /// A cable that gives way in time by more than at once is no cable: cables creep by some per
  /// cent.
  bool gives_way_too_much(const Effect& row, const Eigen::VectorXd& x) const {
    for (Eigen::Index p = 0; p < x.size(); ++p)
      if (row.parameters[static_cast<std::size_t>(p)].unit == kCompliance && x(p) > compliance)
        return true;
    return false;
  }

  VariantColumns columns(const Variant& variant, Evaluation evaluation) const {
    return variant_columns(start.design, variant, start.fit.x, evaluation);
  }
  QuickLook::Products products(const Variant& variant, Evaluation evaluation) const {
    return look.products(active_columns(start.design, variant, start.fit.x, evaluation));
  }
};

std::optional<BlockGrams> grams_with(const Scanner& scanner, const Variant& variant,
                                     Evaluation evaluation) {
  const Design& design = scanner.start.design;
  const double seconds = scanner.settings.block_seconds;
  if (replaces_rows(variant)) {
    const auto columns = replaced_columns(design, variant, evaluation);
    if (columns.empty()) return {};
    return replaced(scanner.start.grams, design.rows, design.stretches, columns, seconds);
  }
  return extended(scanner.start.grams, design.rows, design.stretches,
                  scanner.columns(variant, evaluation), seconds);
}

bool is_line(const Design& design, const Variant& variant) {
  const std::span<const ShapeGrid> shape = variant.effect->shape;
  return shape.size() == 1 && shape.front().n_lines > 0 &&
         variant.shape.front() > shape.front().grid_end(design.scale);
}

/// No candidate where the columns do not exist or are not separable from the others.
std::optional<Candidate> try_variant(const Scanner& scanner, Variant variant,
                                     Evaluation evaluation = Evaluation::fine) {
  const ScanStart& start = scanner.start;
  const auto grams = grams_with(scanner, variant, evaluation);
  if (!grams) return {};
  const Effect& row = *variant.effect;
  const Eigen::Index n = n_linear(variant);
  const bool in_sample = row.passes();
  const auto fit = fit_blocks(*grams, start.levels, !in_sample, {kTolerance, n});
  if (!fit) return {};
  Candidate c;
  c.is_line = is_line(start.design, variant);
  c.variant = std::move(variant);
  c.x = fit->x;
  c.rms = fit->rms();
  c.error = in_sample ? fit->in_sample : fit->held_out;
  const Eigen::ArrayXd& before = in_sample ? start.fit.in_sample : start.fit.held_out;
  if ((fit->alone && !start.fit.alone).any()) return {};  // one block alone determines it
  if (!in_sample) c.error = start.fit.alone.select(0, c.error);
  c.gain = 1 - c.error.sum() / before.sum();
  const Eigen::Index dry = row.takes_dry_friction ? dry_column(start.design, row) : -1;
  const bool too_dry = dry >= 0 && n > 0 && fit->x(fit->x.size() - n) > fit->x(dry);
  const Eigen::VectorXd own = fit->x.tail(n);
  if (too_dry || is_out_of_bounds(row, own) || scanner.gives_way_too_much(row, own))
    c.refused = "beyond its physical bound";
  return c;
}

/// A physical candidate before one that is not, then the larger gain.
bool is_better(const Candidate& a, const Candidate& b) {
  if (a.refused.empty() != b.refused.empty()) return a.refused.empty();
  return a.gain > b.gain;
}

/// A variant with its squared error in sample, and whether it is physical.
struct Looked {
  Variant variant;
  double error = 0;
  bool is_physical = false;
};

/// Nothing where it is not separable. `products`: of the columns of the variant, and perhaps of
/// more.
std::optional<Looked> looked_at(const QuickLook& look, const QuickLook::Products& products,
                                const Variant& variant) {
  const auto glance = look.with(products, n_linear(variant), kTolerance);
  if (!glance) return {};
  return Looked{variant, glance->error, !is_out_of_bounds(*variant.effect, glance->x)};
}

void keep_better(std::optional<Looked>& best, std::optional<Looked> other) {
  if (!other) return;
  if (!best ||
      (other->is_physical != best->is_physical ? other->is_physical : other->error < best->error))
    best = std::move(other);
}

/// Least squared error of the dates in each block of each log.
using ErrorsByBlock = std::map<std::pair<std::size_t, int>, double>;

void keep_least(ErrorsByBlock& errors, const Looked& looked, double block_seconds) {
  const Variant& variant = looked.variant;
  const auto block = static_cast<int>(std::floor(variant.event_time / block_seconds));
  const auto at = errors.try_emplace({variant.event_log, block}, looked.error).first;
  at->second = std::min(at->second, looked.error);
}

double median_error(const ErrorsByBlock& errors) {
  std::vector<double> sorted;
  for (const auto& [block, error] : errors) sorted.push_back(error);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

/// The variant with its nonlinear parameters (and date) where its squared error is least.
Variant moved_shape(const Scanner& scanner, Variant variant, Evaluation evaluation) {
  const Design& design = scanner.start.design;
  const Effect& row = *variant.effect;
  const int rounds = row.passes() ? 3 : 2;  // place and length of what passes pull at each other
  const auto error_with = [&](const Variant& other) {
    if (!replaces_rows(other)) {
      const auto looked = looked_at(scanner.look, scanner.products(other, evaluation), other);
      return looked && looked->is_physical ? looked->error : kUnbounded;
    }
    const auto tried = try_variant(scanner, other, evaluation);
    return tried && tried->refused.empty() ? tried->error.sum() : kUnbounded;
  };
  for (int round = 0; round < rounds; ++round) {
    if (row.is_event) {  // first: what is at the wrong place fits best when it is too long
      const auto [from, to] = dates_around(design, variant, scanner.settings.event_step);
      variant.event_time = golden(from, to, [&](double time) {
        Variant other = variant;
        other.event_time = time;
        return error_with(other);
      });
    }
    for (std::size_t i = 0; i < variant.shape.size(); ++i) {
      if (!is_free(variant, i)) continue;
      const auto [low, high] = around(row.shape[i], variant.shape[i], design.scale);
      variant = with_shape(variant, i, golden(low, high, [&](double value) {
                             return error_with(with_shape(variant, i, value));
                           }));
    }
  }
  return variant;
}

/// Of two forms of one law the plain one, unless the held-out blocks agree on the other.
std::optional<Candidate> simpler(std::optional<Candidate> plain, std::optional<Candidate> full) {
  constexpr double kAgree = 2;  // sd of the paired blocks' difference
  if (!plain || !full) return plain ? plain : full;
  if (plain->refused.empty() != full->refused.empty()) return full->refused.empty() ? full : plain;
  const Paired difference = paired(plain->error, full->error);
  return difference.sum > kAgree * difference.se ? full : plain;
}

/// Of variants with as many parameters, all fitted, the one that fits best; the plain form apart.
std::optional<Candidate> best_fitting(const Scanner& scanner,
                                      const std::vector<Variant>& variants) {
  const bool is_only_one = variants.size() == 1 && !plain_of(variants.front());
  if (is_only_one) return try_variant(scanner, variants.front());
  const QuickLook& look = scanner.look;
  std::optional<Looked> plain, full;
  ErrorsByBlock errors;
  for (const Variant& variant : variants) {
    // Once a row is not enough for what repeats several times from row to row.
    const Evaluation evaluation =
        is_line(scanner.start.design, variant) ? Evaluation::fine : Evaluation::coarse;
    const auto products = scanner.products(variant, evaluation);
    const auto looked = looked_at(look, products, variant);
    if (looked) keep_least(errors, *looked, scanner.settings.block_seconds);
    keep_better(full, looked);
    if (const auto same = plain_of(variant)) keep_better(plain, looked_at(look, products, *same));
  }
  const auto tried = [&](const std::optional<Looked>& looked) -> std::optional<Candidate> {
    if (!looked) return {};
    // Blocks that a coarse date is wrong in would speak against what lasts, and blocks far from
    // the middle against a line whose order is a little off.
    if (looked->variant.effect->lasts())
      return try_variant(scanner, moved_shape(scanner, looked->variant, Evaluation::coarse));
    return try_variant(scanner, is_line(scanner.start.design, looked->variant)
                                    ? moved_shape(scanner, looked->variant, Evaluation::fine)
                                    : looked->variant);
  };
  auto best = simpler(tried(plain), tried(full));
  if (best && best->variant.effect->passes())
    best->elsewhere = 1 - median_error(errors) / scanner.start.fit.in_sample.sum();
  return best;
}

/// What a limit takes away stands out from what the rows that it leaves alone show without it: the
/// peaks of a low-frequency disturbance torque are cut by a limit as well.
bool stands_out(const VariantColumns& change, const VariantColumns& residuals) {
  constexpr double kShareOfMost = 0.1, kTimes = 2;
  double most = 0;
  for (const auto& stretch : change)
    for (const Eigen::MatrixXd& kind : stretch)
      if (kind.size() > 0) most = std::max(most, kind.cwiseAbs().maxCoeff());
  double taken = 0, left = 0, n_taken = 0, n_left = 0;
  for (std::size_t k = 0; k < change.size(); ++k)
    for (std::size_t i = 0; i < change[k].size(); ++i) {
      if (change[k][i].isZero(0)) continue;  // of another equation, or no rows
      for (Eigen::Index row = 0; row < change[k][i].rows(); ++row) {
        const double here = change[k][i](row), before = residuals[k][i](row);
        const bool is_taken = std::abs(here) > kShareOfMost * most;
        (is_taken ? taken : left) += is_taken ? here * here : before * before;
        (is_taken ? n_taken : n_left) += 1;
      }
    }
  return taken * n_left > kTimes * kTimes * left * n_taken;
}

/// A limit or a band of the drive acts in full: what its correction changes has, as a column, a
/// coefficient of about 1. What only resembles such a limit gives another coefficient.
bool acts_in_full(const Scanner& scanner, const Variant& variant) {
  constexpr double kNear = 0.2, kSd = 3;
  const ScanStart& start = scanner.start;
  VariantColumns change = residuals(replaced_rows(start.design, variant), start.fit.x);
  const VariantColumns before = residuals(start.design.rows, start.fit.x);
  for (std::size_t k = 0; k < change.size(); ++k)
    for (std::size_t i = 0; i < change[k].size(); ++i) change[k][i] -= before[k][i];
  const ShapeGrid& grid = variant.effect->shape.front();
  if (grid.is_rare && !stands_out(change, before)) return false;
  const auto fit = fit_blocks(extended(start.grams, start.design.rows, start.design.stretches,
                                       change, scanner.settings.block_seconds),
                              start.levels, false);
  if (!fit) return false;
  const Eigen::Index last = fit->x.size() - 1;
  return std::abs(fit->x(last) - 1) < std::max(kNear, kSd * std::sqrt(fit->covariance(last, last)));
}

/// The same of variants that replace rows.
std::optional<Candidate> best_replacing(const Scanner& scanner,
                                        const std::vector<Variant>& variants) {
  std::optional<Candidate> best;
  for (const Variant& variant : variants) {
    auto candidate = try_variant(scanner, variant, Evaluation::coarse);
    if (candidate && (!best || is_better(*candidate, *best))) best = std::move(candidate);
  }
  if (best) best = try_variant(scanner, best->variant);
  const bool is_correction = best && best->variant.effect->correct != nullptr;
  if (!is_correction || !best->refused.empty() || acts_in_full(scanner, best->variant)) return best;
  // The grid may have missed the limit by half a step.
  auto moved = try_variant(scanner, moved_shape(scanner, best->variant, Evaluation::coarse));
  if (moved && moved->refused.empty() && acts_in_full(scanner, moved->variant)) return moved;
  best->refused = "removing it at full size does not remove the residual";
  return best;
}

/// Those of the grid, and where it is one of orders the lines above it that the residual shows.
std::vector<Variant> variants_to_try(const Scanner& scanner, const Effect& row) {
  const Design& design = scanner.start.design;
  std::vector<Variant> variants = variants_of(row, design, scanner.settings.event_step);
  if (row.shape.size() != 1 || row.shape.front().n_lines == 0) return variants;
  const ShapeGrid& grid = row.shape.front();
  for (const double order :
       strongest_orders(design, scanner.start.fit.x, grid.grid_end(design.scale), grid.n_lines))
    variants.push_back({&row, {order}, 0, 0, false});
  return variants;
}

std::optional<Candidate> best_variant(const Scanner& scanner, const Effect& row) {
  std::vector<Variant> variants = variants_to_try(scanner, row);
  if (variants.empty()) return {};  // no log is long enough for a date
  if (replaces_rows(variants.front())) return best_replacing(scanner, variants);
  auto best = best_fitting(scanner, variants);
  if (!row.takes_dry_friction) return best;
  for (Variant& variant : variants) variant.is_plain = true;
  return simpler(best_replacing(scanner, variants), std::move(best));
}

}  // namespace

std::vector<Candidate> scan(const ScanStart& start, const ScanSettings& settings,
                            const std::vector<const Effect*>& without) {
  const Scanner scanner(start, settings);
  std::vector<const Effect*> rows;
  for (const Effect& row : candidate_effects())
    if (is_candidate(row, start.design) &&
        std::find(without.begin(), without.end(), &row) == without.end())
      rows.push_back(&row);
  std::vector<Candidate> found;
  for (auto& candidate : parallel_map(
           settings.threads, rows, [&](const Effect* row) { return best_variant(scanner, *row); }))
    if (candidate) found.push_back(std::move(*candidate));
  return found;
}

Candidate refined_shape(const ScanStart& start, const ScanSettings& settings,
                        const Candidate& candidate) {
  const Scanner scanner(start, settings);
  const auto moved = [&](const Variant& variant) {
    return try_variant(scanner, moved_shape(scanner, variant, Evaluation::fine));
  };
  auto best = moved(candidate.variant);
  if (has_plain_form(*candidate.variant.effect)) {
    auto other = moved(other_form(candidate.variant));
    const bool is_plain = candidate.variant.is_plain;
    best = simpler(is_plain ? best : other, is_plain ? other : best);
  }
  return best && best->refused.empty() ? *best : candidate;
}

}  // namespace cablefit
