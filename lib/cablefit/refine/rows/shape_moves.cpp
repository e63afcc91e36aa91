#include "cablefit/refine/rows/shape_moves.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

std::vector<FreeShape> free_shapes(const Design& design) {
  std::vector<FreeShape> all;
  for (std::size_t k = 0; k < design.added.size(); ++k)
    for (std::size_t i = 0; i < design.added[k].shape.size(); ++i)
      if (is_free(design.added[k], i)) all.push_back({k, i});
  return all;
}

double unit_of(const Design& design, const FreeShape& at) {
  const Variant& variant = design.added[at.variant];
  const ShapeGrid& grid = variant.effect->shape[at.shape];
  return grid.is_geometric ? std::abs(variant.shape[at.shape])
                           : grid.grid_end(design.scale) - grid.lowest(design.scale);
}

bool can_move(const Variant& variant) {
  const Effect& row = *variant.effect;
  if (row.change != nullptr) return row.change_again != nullptr;
  return row.correct == nullptr;
}

Design with_shapes(Design design, const Eigen::VectorXd& by, const Eigen::VectorXd& values) {
  if (by.size() == 0 || by.isZero(0)) return design;
  const std::vector<FreeShape> all = free_shapes(design);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double step = by(static_cast<Eigen::Index>(k));
    Variant& variant = design.added[all[k].variant];
    if (step == 0 || !can_move(variant)) continue;
    const ShapeGrid& grid = variant.effect->shape[all[k].shape];
    double& value = variant.shape[all[k].shape];
    // What came from other logs may lie outside of what these bound, and goes no further out.
    value = std::clamp(value + step, std::min(value, grid.lowest(design.scale)),
                       std::max(value, grid.highest(design.scale)));
  }
  return relinearised(design, values);
}

namespace {

constexpr double kOwnPart = 1e-4;  // as of a candidate's columns: with less a step goes anywhere

/// Derivative of what the equations leave at x by one free shape; empty: it cannot move.
VariantColumns shape_derivative(const Design& design, const Eigen::VectorXd& x, std::size_t which) {
  constexpr double kStep = 0.02;
  const std::vector<FreeShape> all = free_shapes(design);
  const FreeShape& at = all[which];
  Eigen::VectorXd by = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all.size()));
  auto& own = by(static_cast<Eigen::Index>(which));
  own = kStep * unit_of(design, at);
  const Design more = with_shapes(design, by, x);
  own = -own;
  const Design less = with_shapes(design, by, x);
  const double step =
      more.added[at.variant].shape[at.shape] - less.added[at.variant].shape[at.shape];
  VariantColumns columns;
  if (!(step > 0)) return columns;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    auto& kinds = columns.emplace_back();
    for (std::size_t k = 0; k < design.rows[s].kinds.size(); ++k) {
      const KindRows& high = more.rows[s].kinds[k];
      const KindRows& low = less.rows[s].kinds[k];
      kinds.emplace_back(((high.base - low.base) * x - (high.response - low.response)) / step);
    }
  }
  return columns;
}

}  // namespace

std::optional<ValueChange> change_to_fit(const Design& design, const Eigen::VectorXd& x,
                                         const KindLevels& levels, double block_seconds,
                                         bool (*fixed)(const Effect& row)) {
  const std::vector<FreeShape> all = free_shapes(design);
  ValueChange change{{}, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all.size()))};
  std::vector<StretchRows> rows = design.rows;
  std::vector<std::size_t> moving;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Variant& variant = design.added[all[k].variant];
    if (!can_move(variant) || fixed(*variant.effect)) continue;
    const VariantColumns derivative = shape_derivative(design, x, k);
    if (derivative.empty()) continue;
    append(rows, derivative);
    moving.push_back(k);
  }
  const BlockGrams grams = block_grams(rows, design.stretches, block_seconds);
  if (grams.n_columns < x.size()) return {};
  const std::vector<Eigen::Index> determined =
      determined_columns(grams, levels, x.size(), kOwnPart);
  const auto fit = fit_blocks(with_columns(grams, determined), levels, false);
  if (!fit) return {};
  change.x = fit->x.head(x.size()) - x;
  for (std::size_t i = static_cast<std::size_t>(x.size()); i < determined.size(); ++i)
    change.shapes(
        static_cast<Eigen::Index>(moving[static_cast<std::size_t>(determined[i] - x.size())])) =
        fit->x(static_cast<Eigen::Index>(i));
  return change;
}

}  // namespace cablefit
