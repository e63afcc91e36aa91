#include "cablefit/refine/verdict/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/refine/rows/regime_variables.hpp"

namespace cablefit {
namespace {

constexpr double kApartBy = 3;    // between the halves
constexpr double kSureApart = 3;  // sd of their difference
// Of the effect's squared torque that either half has to hold: the tail of another form of a law
// may be anything.
constexpr double kLeastPart = 0.2;
// Of the halves' columns, squared, that all others leave. Of |qd| the half of one direction is what
// a base has of qd.
constexpr double kOwnShare = 0.01;

/// Half of the rows are above it; of two values, as of a direction, between them.
double middle_of(const Design& design, const RegimeVariable& variable) {
  std::vector<double> values;
  for (std::size_t s = 0; s < design.rows.size(); ++s)
    for (const KindRows& rows : design.rows[s].kinds)
      for (const Eigen::Index at : rows.at)
        values.push_back(value_at(variable, design, s, rows.kind, at));
  if (values.empty()) return 0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (*low == -1 && *high == 1) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Halved {
  std::vector<StretchRows> rows;
  double share = 0;  ///< of the effect's squared torque, above the middle
};

/// The effect's columns in [first, first + n) make room for its torque, and for the same above the
/// middle of the variable alone.
Halved halved(const Design& design, const Eigen::VectorXd& x, Eigen::Index first, Eigen::Index n,
              const RegimeVariable& variable) {
  const double middle = middle_of(design, variable);
  double total = 0;
  Halved out{design.rows, 0};
  for (std::size_t s = 0; s < out.rows.size(); ++s)
    for (KindRows& rows : out.rows[s].kinds) {
      const Eigen::VectorXd torque = rows.base.middleCols(first, n) * x.segment(first, n);
      Eigen::VectorXd above = torque;
      for (Eigen::Index i = 0; i < above.size(); ++i)
        if (value_at(variable, design, s, rows.kind, rows.at[static_cast<std::size_t>(i)]) < middle)
          above(i) = 0;
      const Eigen::Index after = rows.base.cols() - first - n;
      Eigen::MatrixXd base(rows.base.rows(), first + after + 2);
      base << rows.base.leftCols(first), rows.base.rightCols(after), torque, above;
      rows.base = std::move(base);
      total += torque.squaredNorm();
      out.share += above.squaredNorm();
    }
  out.share = total > 0 ? out.share / total : 0;
  return out;
}

}  // namespace

std::string why_not_one_law(const Design& design, const Eigen::VectorXd& x,
                            const KindLevels& levels, std::size_t which, double block_seconds) {
  const Variant& effect = design.added[which];
  const Eigen::Index n = n_linear(effect);
  if (n == 0 || effect.effect->is_event) return "";
  Eigen::Index first = design.layout.n();
  for (std::size_t k = 0; k < which; ++k) first += n_linear(design.added[k]);
  for (const RegimeVariable& variable : regime_variables()) {
    const Halved half = halved(design, x, first, n, variable);
    if (std::min(half.share, 1 - half.share) < kLeastPart) continue;
    const auto fit = fit_blocks(block_grams(half.rows, design.stretches, block_seconds), levels,
                                false, {kOwnShare, 2});
    if (!fit) continue;
    const Eigen::Index last = fit->x.size() - 1;
    const double below = fit->x(last - 1), difference = fit->x(last), above = below + difference;
    const double least = std::min(above, below), most = std::max(above, below);
    const double sd = std::sqrt(fit->covariance(last, last));
    if (std::abs(difference) > kSureApart * sd && least < most / kApartBy)
      return fmt::format(
          "its size differs between halves of the samples: {:.2g} at the lower {}, {:.2g} at the "
          "higher (all samples: 1)",
          below, variable.regime, above);
  }
  return "";
}

}  // namespace cablefit
