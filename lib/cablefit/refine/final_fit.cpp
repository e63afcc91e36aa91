#include "cablefit/refine/final_fit.hpp"

#include <cmath>
#include <limits>

#include "cablefit/estimate/scaled_solve.hpp"

namespace cablefit {
namespace {

constexpr double kShapeStep = 0.02;  // of a nonlinear parameter, for a central difference

Eigen::Index count_rows(const std::vector<StretchRows>& rows) {
  Eigen::Index n = 0;
  for (const StretchRows& stretch : rows)
    for (const KindRows& kind : stretch.kinds) n += kind.response.size();
  return n;
}

/// What the equations leave, stretch by stretch, kind by kind.
VariantColumns residuals(const std::vector<StretchRows>& rows, const Eigen::VectorXd& x) {
  VariantColumns all;
  for (const StretchRows& stretch : rows) {
    auto& kinds = all.emplace_back();
    for (const KindRows& kind : stretch.kinds) kinds.emplace_back(kind.base * x - kind.response);
  }
  return all;
}

/// The design with all variants again, one of their shapes moved.
Design with_shape(const Design& undone, const Design& design, const Eigen::VectorXd& x,
                  std::size_t which, std::size_t shape, double value) {
  Design out = undone;
  for (std::size_t k = 0; k < design.added.size(); ++k) {
    Variant variant = design.added[k];
    if (k == which) variant.shape[shape] = value;
    out = with_variant(out, variant, x.head(out.n_columns()));
  }
  return out;
}

/// Derivative of the residuals by one nonlinear parameter.
VariantColumns shape_column(const Design& undone, const Design& design, const Eigen::VectorXd& x,
                            std::size_t which, std::size_t shape) {
  const double value = design.added[which].shape[shape];
  const double step = kShapeStep * std::abs(value);
  const Design more = with_shape(undone, design, x, which, shape, value + step);
  const Design less = with_shape(undone, design, x, which, shape, value - step);
  VariantColumns column = residuals(more.rows, x);
  const VariantColumns low = residuals(less.rows, x);
  for (std::size_t s = 0; s < column.size(); ++s)
    for (std::size_t k = 0; k < column[s].size(); ++k)
      column[s][k] = (column[s][k] - low[s][k]) / (2 * step);
  return column;
}

/// Grams of the linear columns and one column per nonlinear parameter.
BlockGrams with_shape_columns(const Design& undone, const Design& design, const Eigen::VectorXd& x,
                              double block_seconds) {
  std::vector<StretchRows> rows = design.rows;
  for (std::size_t k = 0; k < design.added.size(); ++k)
    for (std::size_t i = 0; i < design.added[k].shape.size(); ++i) {
      if (!is_free(design.added[k], i)) continue;
      const VariantColumns column = shape_column(undone, design, x, k, i);
      for (std::size_t s = 0; s < rows.size(); ++s)
        for (std::size_t kind = 0; kind < rows[s].kinds.size(); ++kind) {
          Eigen::MatrixXd& base = rows[s].kinds[kind].base;
          base.conservativeResize(Eigen::NoChange, base.cols() + 1);
          base.rightCols(1) = column[s][kind];
        }
    }
  return block_grams(rows, design.stretches, block_seconds);
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
  fit.rms = rms_of(block_grams(design.rows, design.stretches, block_seconds), fit.x);
  const BlockGrams grams = with_shape_columns(undone, design, fit.x, block_seconds);
  const Eigen::Index q = grams.n_columns;
  fit.covariance =
      jackknife_covariance(grams, levels)
          .value_or(Eigen::MatrixXd::Constant(q, q, std::numeric_limits<double>::quiet_NaN()));
  fit.degrees_of_freedom =
      std::max(1.0, static_cast<double>(grams.blocks.size()) - static_cast<double>(q));
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
