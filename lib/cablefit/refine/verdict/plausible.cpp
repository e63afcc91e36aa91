#include "cablefit/refine/verdict/plausible.hpp"

#include <fmt/format.h>

#include <cmath>

namespace cablefit {
namespace {

constexpr double kAtEnd = 0.97;    // of the highest value
constexpr double kMostParts = 20;  // rms of the parts together, in rms of their sum
// Of the largest deflection: twice for the whole range, and once more for its rare values.
constexpr double kMostStep = 3;

std::string at_open_end(const Variant& variant, const LogScale& scale) {
  const Effect& row = *variant.effect;
  for (std::size_t k = 0; k < row.shape.size(); ++k) {
    const ShapeGrid& grid = row.shape[k];
    if (!grid.is_open_above || variant.shape[k] < kAtEnd * grid.highest(scale)) continue;
    const ParameterInfo& info = row.parameters[row.n_linear() + k];
    return fmt::format("{} = {:.3g} {} is at the end of its range: the logs show a slower process",
                       info.name, variant.shape[k], info.unit);
  }
  return "";
}

std::string larger_than_deflection(const Effect& row, const LogScale& scale, double step) {
  if (!row.steps_deflection || std::abs(step) <= kMostStep * scale.deflection) return "";
  return fmt::format("{:.3g} rad are more than the logs show: the deflection is at most {:.3g} rad",
                     std::abs(step), scale.deflection);
}

/// Rms of the parts together over that of their sum; 1 for a single one.
double parts_over_sum(const Design& design, const Eigen::VectorXd& x, Eigen::Index n) {
  double parts = 0, sum = 0;
  for (const StretchRows& stretch : design.rows)
    for (const KindRows& rows : stretch.kinds) {
      const Eigen::MatrixXd own = rows.base.rightCols(n) * x.tail(n).asDiagonal();
      parts += own.squaredNorm();
      sum += own.rowwise().sum().squaredNorm();
    }
  return sum > 0 ? std::sqrt(parts / sum) : 1;
}

}  // namespace

std::string why_not_plausible(const Design& design, const Eigen::VectorXd& x) {
  const Variant& variant = design.added.back();
  const Eigen::Index dry =
      variant.effect->takes_dry_friction ? dry_column(design, *variant.effect) : -1;
  if (dry >= 0 && !(x(dry) > 0)) return "with it the axis has no dry friction that it could act on";
  if (std::string reason = at_open_end(variant, design.scale); !reason.empty()) return reason;
  const Eigen::Index n = n_linear(variant);
  if (n == 1) return larger_than_deflection(*variant.effect, design.scale, x[x.size() - 1]);
  if (n < 2) return "";
  const double parts = parts_over_sum(design, x, n);
  if (parts <= kMostParts) return "";
  return fmt::format("its parts cancel each other: they are {:.0f} times as large as their sum",
                     parts);
}

}  // namespace cablefit
