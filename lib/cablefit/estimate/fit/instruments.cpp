#include "cablefit/estimate/fit/instruments.hpp"

#include <Eigen/QR>
#include <limits>

#include "cablefit/estimate/solve/constrained_least_squares.hpp"

namespace cablefit {
double first_stage_f(double share, double effective_rows) {
  return share < 1 ? effective_rows * share / (1 - share) : std::numeric_limits<double>::infinity();
}

Instruments::Instruments(const RowStatistics& rows, const std::vector<Eigen::Index>& columns)
    : columns_(columns) {
  if (columns.empty()) return;
  Eigen::MatrixXd z = rows.r()(Eigen::all, columns);
  Eigen::VectorXd norm = z.colwise().norm();
  for (double& n : norm)
    if (!(n > 0)) n = 1;
  z = z * norm.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(z);
  qr.setThreshold(kRankTolerance);
  const Eigen::Index rank = qr.rank();
  basis_ = qr.householderQ() * Eigen::MatrixXd::Identity(z.rows(), rank);
  Eigen::MatrixXd pivoted = Eigen::MatrixXd::Zero(z.cols(), rank);
  pivoted.topRows(rank) = qr.matrixR()
                              .topLeftCorner(rank, rank)
                              .triangularView<Eigen::Upper>()
                              .solve(Eigen::MatrixXd::Identity(rank, rank));
  coefficients_ = norm.cwiseInverse().asDiagonal() * (qr.colsPermutation() * pivoted);
}

Eigen::MatrixXd Instruments::project(const Eigen::MatrixXd& columns) const {
  if (columns_.empty()) return columns;
  Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  seen.topRows(basis_.cols()) = basis_.transpose() * columns;
  return seen;
}

Eigen::MatrixXd Instruments::score_columns(const RowStatistics& rows,
                                           const std::vector<Eigen::Index>& regressors) const {
  const auto p = static_cast<Eigen::Index>(regressors.size());
  Eigen::MatrixXd score = Eigen::MatrixXd::Zero(rows.n_columns(), p);
  if (columns_.empty()) {
    for (Eigen::Index k = 0; k < p; ++k) score(regressors[static_cast<std::size_t>(k)], k) = 1;
    return score;
  }
  const Eigen::MatrixXd w = rows.r()(Eigen::all, regressors);
  const Eigen::MatrixXd combination = coefficients_ * (basis_.transpose() * w);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    score.row(columns_[i]) += combination.row(static_cast<Eigen::Index>(i));
  return score;
}

}  // namespace cablefit
