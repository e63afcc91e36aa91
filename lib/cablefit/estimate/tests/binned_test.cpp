#include "cablefit/estimate/tests/binned_test.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "cablefit/base/divided_up.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"

namespace cablefit {
namespace {

// Share of a difference between bins that the regressors must leave for it to be tested.
constexpr double kLeft = 0.1;
constexpr double kLeastDof = 4;  // of the denominator of F

/// Directions of the bins, as columns, in which white scores with covariance `white` have variance
/// 1; those that are next to nothing are left out.
Eigen::MatrixXd whitening(const Eigen::MatrixXd& white, const Eigen::VectorXd& rows_in_bin) {
  const Eigen::VectorXd scale = rows_in_bin.cwiseMax(1).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * white *
                                                             scale.asDiagonal());
  Eigen::Index first = 0;
  while (first < white.rows() && !(eigen.eigenvalues()(first) > kLeft)) ++first;
  const Eigen::Index n = white.rows() - first;
  return scale.asDiagonal() * eigen.eigenvectors().rightCols(n) *
         eigen.eigenvalues().tail(n).cwiseSqrt().cwiseInverse().asDiagonal();
}

/// u' v^-1 u of a covariance that a cut-off kernel may have left not quite positive.
double quadratic_form(const Eigen::MatrixXd& v, const Eigen::VectorXd& u) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(v);
  const double least = 1e-6 * eigen.eigenvalues().maxCoeff();
  const Eigen::VectorXd turned = eigen.eigenvectors().transpose() * u;
  return turned.cwiseAbs2().cwiseQuotient(eigen.eigenvalues().cwiseMax(least)).sum();
}

}  // namespace

Eigen::Index stretch_places(Eigen::Index last) {
  constexpr Eigen::Index kMostStretches = 1024;
  return std::max<Eigen::Index>(1, divided_up(last + 1, kMostStretches));
}

std::vector<double> bin_edges(std::vector<double> values, std::size_t n_bins) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  std::sort(values.begin(), values.end());
  std::vector<double> edges;
  if (values.empty() || n_bins < 2) return edges;
  // As few levels as bins: halfway between them; a quantile could fall on one of them.
  std::vector<double> levels;
  const double same = 1e-9 * std::max(std::abs(values.front()), std::abs(values.back()));
  for (const double v : values) {
    if (levels.empty() || v > levels.back() + same) levels.push_back(v);
    if (levels.size() > n_bins) break;
  }
  if (levels.size() <= n_bins) {
    for (std::size_t k = 1; k < levels.size(); ++k)
      edges.push_back((levels[k - 1] + levels[k]) / 2);
    return edges;
  }
  for (std::size_t k = 1; k < n_bins; ++k) {
    const double edge = values[k * values.size() / n_bins];
    if (edge > values.front() && (edges.empty() || edge > edges.back())) edges.push_back(edge);
  }
  return edges;
}

std::size_t bin_of(double value, const std::vector<double>& edges) {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), value) -
                                  edges.begin());
}

BinnedTest::BinnedTest(std::vector<double> edges, Eigen::Index n_regressors,
                       Eigen::Index cell_places)
    : edges_(std::move(edges)),
      n_bins_(static_cast<Eigen::Index>(edges_.size()) + 1),
      cell_places_(std::max<Eigen::Index>(1, cell_places)),
      rows_in_bin_(Eigen::VectorXd::Zero(n_bins_)),
      variable_in_bin_(Eigen::VectorXd::Zero(n_bins_)),
      cross_(Eigen::MatrixXd::Zero(n_bins_, n_regressors)),
      gram_(Eigen::MatrixXd::Zero(n_regressors, n_regressors)) {}

BinnedTest::Cell& BinnedTest::cell_at(Eigen::Index number) {
  const Eigen::Index id = number / cell_places_;
  if (cells_.empty() || cells_.back().id != id)
    cells_.push_back({id, Eigen::VectorXd::Zero(n_bins_), Eigen::VectorXd::Zero(gram_.rows())});
  return cells_.back();
}

void BinnedTest::add(std::span<const Eigen::Index> numbers,
                     const Eigen::Ref<const Eigen::VectorXd>& variable,
                     const Eigen::Ref<const Eigen::VectorXd>& residual,
                     const Eigen::Ref<const Eigen::MatrixXd>& regressors) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (!std::isfinite(variable(row))) continue;
    const auto bin = static_cast<Eigen::Index>(bin_of(variable(row), edges_));
    Cell& cell = cell_at(numbers[i]);
    cell.bins(bin) += residual(row);
    cell.regressors += residual(row) * regressors.row(row).transpose();
    rows_in_bin_(bin) += 1;
    squares_ += residual(row) * residual(row);
    variable_in_bin_(bin) += variable(row);
    cross_.row(bin) += regressors.row(row);
    gram_ += regressors.row(row).transpose() * regressors.row(row);
  }
}

BinnedTestResult BinnedTest::of_fitted_rows() const {
  Eigen::VectorXd scale = gram_.diagonal().cwiseSqrt();
  for (double& s : scale) s = s > 0 ? 1 / s : 0;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram_ * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scale.asDiagonal() *
                                  scaled.completeOrthogonalDecomposition().pseudoInverse() *
                                  scale.asDiagonal();
  const Eigen::MatrixXd own = cross_ * inverse;
  const Eigen::MatrixXd white =
      Eigen::MatrixXd(rows_in_bin_.asDiagonal()) - own * cross_.transpose();
  return judged(own, white, Eigen::MatrixXd::Zero(n_bins_, n_bins_));
}

BinnedTestResult BinnedTest::of_unseen_rows(const Eigen::MatrixXd& parameter_covariance) const {
  return judged(Eigen::MatrixXd::Zero(n_bins_, gram_.rows()), rows_in_bin_.asDiagonal(),
                cross_ * parameter_covariance * cross_.transpose());
}

BinnedTestResult BinnedTest::judged(const Eigen::MatrixXd& own, const Eigen::MatrixXd& white,
                                    const Eigen::MatrixXd& extra) const {
  BinnedTestResult out;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(n_bins_);
  for (const Cell& cell : cells_) sums += cell.bins;
  const Eigen::VectorXd means = sums.cwiseQuotient(rows_in_bin_.cwiseMax(1));
  if (squares_ > 0) out.explained = sums.dot(means) / squares_;
  const Eigen::MatrixXd turn = whitening(white, rows_in_bin_);
  const Eigen::Index k = turn.cols();
  if (k == 0 || cells_.size() < 8) return out;
  // A row per stretch of time, zeros where there are no rows of the equation.
  std::vector<GramCell> stretches;
  for (const Cell& cell : cells_) stretches.push_back({cell.id, 0, {}});
  std::size_t next = 0;
  const Eigen::MatrixXd scores =
      series_over_time(stretches, k, [&](const GramCell&) -> Eigen::RowVectorXd {
        const Cell& cell = cells_[next++];
        return (cell.bins - own * cell.regressors).transpose() * turn;
      });
  const LongRunCovariance hac = long_run_covariance(scores);
  const Eigen::VectorXd total = scores.colwise().sum();
  const Eigen::MatrixXd v = hac.covariance + turn.transpose() * extra * turn;
  out.dof_1 = static_cast<double>(k);
  out.dof_2 = hac.degrees_of_freedom - out.dof_1 + 1;
  if (!(out.dof_2 >= kLeastDof) || !(v.trace() > 0)) return out;
  out.is_possible = true;
  out.f = quadratic_form(v, total) * out.dof_2 / (hac.degrees_of_freedom * out.dof_1);
  out.p_value = f_tail(out.f, out.dof_1, out.dof_2);
  out.structure = std::sqrt(std::max(0.0, total.squaredNorm() - v.trace()) / rows_in_bin_.sum());
  out.detectable = std::sqrt(2 * v.trace() / rows_in_bin_.sum());
  Eigen::Index at = 0;
  means.cwiseAbs().maxCoeff(&at);
  out.largest = means(at);
  out.largest_at = variable_in_bin_(at) / std::max(1.0, rows_in_bin_(at));
  return out;
}

}  // namespace cablefit
