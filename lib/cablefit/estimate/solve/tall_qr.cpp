#include "cablefit/estimate/solve/tall_qr.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "cablefit/estimate/solve/tall_gram.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kSampleStep = 16;    // every so many rows are the sample
constexpr Eigen::Index kRowsPerColumn = 8;  // in the sample; fewer rows do not stand for the rest
// Rows that stay near the processor; not a power of two, or all columns would fall on the same few
// lines of the first-level cache.
constexpr Eigen::Index kBlock = 248;
constexpr double kNull = 1e-7;    // diagonal of R0 over its column's norm: the column says nothing
constexpr double kSkewed = 0.05;  // share of a column that the ones before leave, at least

Eigen::MatrixXd householder(Eigen::MatrixXd rows) {
  const Eigen::Index n = rows.cols();
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(n, n);
  const Eigen::Index m = std::min(n, rows.rows());
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(rows);
  r.topRows(m) = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
  return r;
}

Eigen::MatrixXd blocked_householder(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  const Eigen::Index n = rows.cols();
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += kBlock) {
    const Eigen::Index m = std::min(kBlock, rows.rows() - begin);
    Eigen::MatrixXd stack(n + m, n);
    stack << r, rows.middleRows(begin, m);
    r = householder(std::move(stack));
  }
  return r;
}

/// Every 16th row's R. A column that the others explain, or that is zero, keeps its scale as the
/// diagonal, so that dividing by R leaves of it what little is not explained.
Eigen::MatrixXd preconditioner(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  const Eigen::Index n_sample = rows.rows() / kSampleStep;
  Eigen::MatrixXd sample(n_sample, rows.cols());
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    for (Eigen::Index i = 0; i < n_sample; ++i) sample(i, k) = rows(i * kSampleStep, k);
  Eigen::MatrixXd r = householder(std::move(sample));
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    const double norm = r.col(k).norm();
    if (!(std::abs(r(k, k)) > kNull * norm)) r(k, k) = norm > 0 ? norm : 1;
  }
  return r;
}

/// Upper factor of the Gram matrix of `n_rows` nearly orthogonal rows; null when they are not.
/// Columns in which next to nothing is left are as good as zero.
std::optional<Eigen::MatrixXd> upper_cholesky(const Eigen::MatrixXd& gram, Eigen::Index n_rows) {
  const double nothing = kNull * kNull * static_cast<double>(n_rows);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(gram.rows(), gram.cols());
  for (Eigen::Index k = 0; k < gram.cols(); ++k) {
    for (Eigen::Index i = 0; i < k; ++i)
      if (u(i, i) > 0) u(i, k) = (gram(i, k) - u.col(i).head(i).dot(u.col(k).head(i))) / u(i, i);
    const double pivot = gram(k, k) - u.col(k).head(k).squaredNorm();
    const bool is_independent = pivot > kSkewed * kSkewed * gram(k, k);
    if (!is_independent && gram(k, k) > nothing) return std::nullopt;
    u(k, k) = std::sqrt(std::max(0.0, pivot));
  }
  return u;
}

std::optional<Eigen::MatrixXd> cholesky_qr(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  const Eigen::Index n = rows.cols();
  if (rows.rows() / kSampleStep < kRowsPerColumn * n) return std::nullopt;
  const Eigen::MatrixXd r0 = preconditioner(rows);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd block;
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += kBlock) {
    block = rows.middleRows(begin, std::min(kBlock, rows.rows() - begin));
    divide_by_triangle(block, r0);
    add_gram(block, gram);
  }
  const auto u = upper_cholesky(gram, rows.rows());
  if (!u) return std::nullopt;
  return *u * r0;
}

}  // namespace

Eigen::MatrixXd tall_qr(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  if (auto r = cholesky_qr(rows)) return *std::move(r);
  return blocked_householder(rows);
}

}  // namespace cablefit
