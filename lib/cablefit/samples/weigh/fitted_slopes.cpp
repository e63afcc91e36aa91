#include "cablefit/samples/weigh/fitted_slopes.hpp"

#include <Eigen/QR>
#include <cmath>
#include <vector>

namespace cablefit {
namespace {

constexpr double kRounding = 1e-9;  // of the largest value: less is no variation
constexpr double kMostLeft = 0.5;   // of the variance
constexpr Eigen::Index kRowsPerColumn = 10;

/// Columns about their means, of unit norm, and those left out that do not vary.
struct ScaledColumns {
  Eigen::MatrixXd columns;
  std::vector<Eigen::Index> kept;
  std::vector<double> norms;
};

ScaledColumns scaled(const Eigen::MatrixXd& columns) {
  ScaledColumns s{Eigen::MatrixXd(columns.rows(), columns.cols()), {}, {}};
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const Eigen::VectorXd about = columns.col(k).array() - columns.col(k).mean();
    if (about.lpNorm<Eigen::Infinity>() <= kRounding * columns.col(k).lpNorm<Eigen::Infinity>())
      continue;
    s.norms.push_back(about.norm());
    s.columns.col(static_cast<Eigen::Index>(s.kept.size())) = about / s.norms.back();
    s.kept.push_back(k);
  }
  s.columns.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(s.kept.size()));
  return s;
}

}  // namespace

FittedSlopes fitted_slopes(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
  if (y.size() < kRowsPerColumn * (columns.cols() + 1)) return {};
  const auto [scaled_columns, kept, norms] = scaled(columns);
  const auto n = static_cast<Eigen::Index>(kept.size());
  if (n == 0) return {};
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled_columns);
  if (qr.rank() < n) return {};
  const Eigen::VectorXd about = y.array() - y.mean();
  const Eigen::VectorXd x = qr.solve(about);
  const double left = (about - scaled_columns * x).squaredNorm();
  if (left > kMostLeft * about.squaredNorm()) return {};
  const Eigen::MatrixXd root =
      qr.matrixR().topRows(n).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd sd = std::sqrt(left / static_cast<double>(y.size() - n - 1)) *
                             (qr.colsPermutation() * root).rowwise().norm();
  FittedSlopes slopes{Eigen::VectorXd::Zero(columns.cols()), Eigen::VectorXd::Zero(columns.cols())};
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    slopes.value(kept[at]) = x(k) / norms[at];
    slopes.sd(kept[at]) = sd(k) / norms[at];
  }
  return slopes;
}

}  // namespace cablefit
