#include "cablefit/simulate/start_state.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr Eigen::Index kHalfWidths[] = {kStartRows, 20, 13, 8, 5, 3};
constexpr Eigen::Index kCoefficients = 4;  // of a cubic
constexpr double kTolerance = 1.5;         // of the noise: sampling error of its sd over few rows

struct Cubic {
  StartState state;
  double misfit = 0;  ///< sd of the residual, rad
};

/// Rows [first, last] of the neighbourhood; at an end as wide as in the middle.
struct Span {
  Eigen::Index first, n_rows;
};

Span around(Eigen::Index row, Eigen::Index half_width, Eigen::Index n_rows) {
  const Eigen::Index wanted = std::min(2 * half_width + 1, n_rows);
  const Eigen::Index first = std::clamp<Eigen::Index>(row - half_width, 0, n_rows - wanted);
  return {first, wanted};
}

Cubic fit_cubic(const Eigen::Ref<const Eigen::ArrayXd>& positions, Eigen::Index row, Span span,
                double period) {
  const Eigen::Index n_terms = std::min(kCoefficients, span.n_rows);
  const double scale = static_cast<double>(span.n_rows);
  Eigen::MatrixXd powers(span.n_rows, n_terms);
  for (Eigen::Index i = 0; i < span.n_rows; ++i) {
    const double x = static_cast<double>(span.first + i - row) / scale;
    for (Eigen::Index k = 0; k < n_terms; ++k) powers(i, k) = std::pow(x, static_cast<double>(k));
  }
  const Eigen::VectorXd y = positions.segment(span.first, span.n_rows) - positions(row);
  const Eigen::VectorXd c = powers.householderQr().solve(y);
  const auto dof = static_cast<double>(std::max<Eigen::Index>(1, span.n_rows - n_terms));
  return {{positions(row) + c(0), n_terms > 1 ? c(1) / (scale * period) : 0.0},
          (y - powers * c).norm() / std::sqrt(dof)};
}

}  // namespace

StartState start_state(const Eigen::Ref<const Eigen::ArrayXd>& positions, Eigen::Index row,
                       double period, double noise) {
  Cubic cubic;
  for (const Eigen::Index half_width : kHalfWidths) {
    const Span span = around(row, half_width, positions.size());
    const auto there = positions.segment(span.first, span.n_rows);
    if (there.maxCoeff() == there.minCoeff()) return {positions(row), 0.0};
    cubic = fit_cubic(positions, row, span, period);
    if (cubic.misfit <= kTolerance * noise) break;
  }
  return cubic.state;
}

}  // namespace cablefit
