#include "cablefit/refine/rows/final_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "cablefit/estimate/solve/scaled_solve.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"

namespace cablefit {
namespace {

constexpr double kShapeStep = 0.02;  // of the unit of a nonlinear parameter
constexpr double kDateStep = 5e-3;   // s, of an event

/// The design with all variants again, one of them another; nothing where they do not apply.
std::optional<Design> with_other(const Design& undone, const Design& design,
                                 const Eigen::VectorXd& x, std::size_t which,
                                 const Variant& other) {
  Design out = undone;
  for (std::size_t k = 0; k < design.added.size(); ++k) {
    const Variant& variant = k == which ? other : design.added[k];
    if (!applies(out, variant)) return {};
    out = with_variant(out, variant, x.head(out.n_columns()));
  }
  return out;
}

/// Derivative of the residuals by a nonlinear parameter of one variant: central, from the variants
/// with `step` more and less. 0, which determines nothing, where one of these does not exist.
VariantColumns derivative(const Design& undone, const Design& design, const Eigen::VectorXd& x,
                          std::size_t which, const std::array<Variant, 2>& less_more, double step) {
  const auto less = with_other(undone, design, x, which, less_more[0]);
  const auto more = with_other(undone, design, x, which, less_more[1]);
  const bool is_there = less && more;
  VariantColumns column = residuals(is_there ? more->rows : design.rows, x);
  const VariantColumns low = is_there ? residuals(less->rows, x) : column;
  for (std::size_t s = 0; s < column.size(); ++s)
    for (std::size_t k = 0; k < column[s].size(); ++k)
      column[s][k] = (column[s][k] - low[s][k]) / (2 * step);
  return column;
}

/// Grams of the linear columns, one column per nonlinear parameter, and one per date, which is not
/// reported but blurs the rest.
BlockGrams with_shape_columns(const Design& undone, const Design& design, const Eigen::VectorXd& x,
                              double block_seconds) {
  std::vector<StretchRows> rows = design.rows;
  const auto add = [&](std::size_t k, double step, auto move) {
    std::array<Variant, 2> less_more{design.added[k], design.added[k]};
    move(less_more[0], -step);
    move(less_more[1], step);
    append(rows, derivative(undone, design, x, k, less_more, step));
  };
  for (const FreeShape& at : free_shapes(design))
    add(at.variant, kShapeStep * unit_of(design, at),
        [&at](Variant& variant, double by) { variant.shape[at.shape] += by; });
  for (std::size_t k = 0; k < design.added.size(); ++k)
    if (design.added[k].effect->is_event)
      add(k, kDateStep, [](Variant& variant, double by) { variant.event_time += by; });
  return block_grams(rows, design.stretches, block_seconds);
}

/// For an event within one block the other blocks contain no information: by the noise of its rows.
Eigen::MatrixXd noise_covariance(const BlockGrams& grams, const KindLevels& levels) {
  const Eigen::Index q = grams.n_columns;
  const Eigen::MatrixXd gram = weighted_sum(grams, levels).bottomRightCorner(q, q);
  const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> llt(scale.asDiagonal() * gram * scale.asDiagonal());
  if (!scale.allFinite() || llt.info() != Eigen::Success)
    return Eigen::MatrixXd::Constant(q, q, std::numeric_limits<double>::quiet_NaN());
  return scale.asDiagonal() * llt.solve(Eigen::MatrixXd::Identity(q, q)) * scale.asDiagonal();
}

/// How many neighbouring rows are worth one: sum of the autocorrelation of white noise behind the
/// kernel of the columns.
double rows_per_value(const Smoothing& smoothing) {
  const double step = smoothing.row_period() / (2 * smoothing.columns);
  double sum = 1;
  for (int k = 1; k * step < 3; ++k) sum += 2 * std::exp(-(k * step) * (k * step));
  return sum;
}

/// Of all columns; NaN for parameters that the rows do not determine, such as the share of the load
/// at which a log starts settled when it starts without load.
Eigen::MatrixXd determined_covariance(const BlockGrams& grams, const KindLevels& levels,
                                      Eigen::Index n_linear, double rows_per_value) {
  const std::vector<Eigen::Index> determined = determined_columns(grams, levels, n_linear);
  const BlockGrams some = with_columns(grams, determined);
  const auto jackknife = jackknife_covariance(some, levels);
  Eigen::MatrixXd all = Eigen::MatrixXd::Constant(grams.n_columns, grams.n_columns,
                                                  std::numeric_limits<double>::quiet_NaN());
  all(determined, determined) =
      jackknife ? *jackknife : noise_covariance(some, levels) * rows_per_value;
  return all;
}

}  // namespace

std::vector<Eigen::Index> first_columns(const Design& design) {
  std::vector<Eigen::Index> first;
  Eigen::Index next = design.layout.n();
  for (const Variant& variant : design.added) {
    first.push_back(next);
    next += n_linear(variant);
  }
  return first;
}

FinalFit final_fit(const Design& undone, const Design& design, const KindLevels& levels,
                   double block_seconds) {
  const Eigen::Index n = count_rows(design.rows), p = design.n_columns();
  Eigen::MatrixXd a(n, p);
  Eigen::VectorXd b(n);
  Eigen::Index at = 0;
  for (const StretchRows& stretch : design.rows)
    for (const KindRows& kind : stretch.kinds) {
      const double weight = 1 / levels[static_cast<std::size_t>(kind.kind)];
      a.middleRows(at, kind.response.size()) = weight * kind.base;
      b.segment(at, kind.response.size()) = weight * kind.response;
      at += kind.response.size();
    }
  FinalFit fit;
  fit.x = solve_scaled(a, b).x;
  fit.rms = rms_of(block_grams(design, block_seconds), fit.x);
  const BlockGrams grams = with_shape_columns(undone, design, fit.x, block_seconds);
  fit.covariance = determined_covariance(grams, levels, p, rows_per_value(design.smoothing));
  fit.degrees_of_freedom = std::max(
      1.0, static_cast<double>(count_blocks(grams)) - static_cast<double>(grams.n_columns));
  return fit;
}

double carried_torque(const Design& design, const Eigen::VectorXd& x, Eigen::Index first,
                      Eigen::Index n) {
  double squares = 0, rows = 0;
  for (const StretchRows& stretch : design.rows)
    for (const KindRows& kind : stretch.kinds) {
      const Eigen::VectorXd torque = kind.base.middleCols(first, n) * x.segment(first, n);
      if (torque.squaredNorm() == 0) continue;
      squares += torque.squaredNorm();
      rows += static_cast<double>(torque.size());
    }
  return rows > 0 ? std::sqrt(squares / rows) : 0;
}

}  // namespace cablefit
