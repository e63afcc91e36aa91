#include "cablefit/estimate/solve/tall_qr.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "cablefit/estimate/solve/tall_gram.hpp"

namespace cablefit {
namespace {

using TallRows = Eigen::Ref<const Eigen::MatrixXd>;

// Every step-th row is in the sample: the largest step, and the smallest one, below which plain
// Householder is as quick.
constexpr Eigen::Index kMostStep = 16, kLeastStep = 3;
constexpr Eigen::Index kRowsPerColumn = 8;  // in the sample; fewer rows do not stand for the rest
// Rows per column of a stretch, on average. For fewer, its plain Gram matrix costs less than
// R0'GR0.
constexpr Eigen::Index kLongStretch = 8;
// Where a stretch has less than this share of a column's mean square, R0'GR0 is not exact enough.
constexpr double kFaint = 1e-3;
// Rows that stay near the processor; not a power of two, or all columns would fall on the same
// few lines of the first-level cache.
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

Eigen::MatrixXd blocked_householder(const TallRows& rows) {
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

struct Preconditioner {
  Eigen::MatrixXd r0;
  Eigen::Index n_sample = 0;
};

/// R of every step-th row. A column that the others explain, or that is zero, keeps its scale as
/// the diagonal, so that dividing by R leaves of it what little is not explained.
Preconditioner preconditioner(const TallRows& rows, Eigen::Index step) {
  const Eigen::Index n_sample = rows.rows() / step;
  Eigen::MatrixXd sample(n_sample, rows.cols());
  for (Eigen::Index k = 0; k < rows.cols(); ++k)
    for (Eigen::Index i = 0; i < n_sample; ++i) sample(i, k) = rows(i * step, k);
  Eigen::MatrixXd r = householder(std::move(sample));
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    const double norm = r.col(k).norm();
    if (!(std::abs(r(k, k)) > kNull * norm)) r(k, k) = norm > 0 ? norm : 1;
  }
  return {std::move(r), n_sample};
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

/// Gram matrix of rows r0^-1, upper triangle, block by block.
Eigen::MatrixXd orthogonal_gram(const TallRows& rows, const Eigen::MatrixXd& r0) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  Eigen::MatrixXd block;
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += kBlock) {
    block = rows.middleRows(begin, std::min(kBlock, rows.rows() - begin));
    divide_by_triangle(block, r0);
    add_gram(block, gram);
  }
  return gram;
}

/// Copies the upper triangle to the lower one.
void make_symmetric(Eigen::MatrixXd& gram) {
  gram.triangularView<Eigen::StrictlyLower>() = gram.transpose();
}

Eigen::MatrixXd plain_gram(const TallRows& rows) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  add_gram(rows, gram);
  make_symmetric(gram);
  return gram;
}

/// The Gram matrix of the rows from `gram`, that of rows r0^-1, where this is exact enough.
Eigen::MatrixXd restored_gram(const Eigen::MatrixXd& gram, const Preconditioner& p,
                              const TallRows& rows) {
  Eigen::MatrixXd restored = p.r0.transpose() * gram.selfadjointView<Eigen::Upper>() * p.r0;
  const double share = static_cast<double>(rows.rows()) / static_cast<double>(p.n_sample);
  for (Eigen::Index k = 0; k < restored.cols(); ++k)
    if (restored(k, k) < kFaint * share * p.r0.col(k).squaredNorm()) return plain_gram(rows);
  make_symmetric(restored);
  return restored;
}

TallRows stretch(const TallRows& rows, std::span<const Eigen::Index> ends, std::size_t k) {
  const Eigen::Index begin = k == 0 ? 0 : ends[k - 1];
  return rows.middleRows(begin, ends[k] - begin);
}

/// Null where Householder is better: the rows are few, or the sample is not like them.
std::optional<TallQr> cholesky_qr(const TallRows& rows, std::span<const Eigen::Index> ends,
                                  bool with_grams) {
  const Eigen::Index n = rows.cols();
  const Eigen::Index step = std::min(kMostStep, rows.rows() / (kRowsPerColumn * n));
  if (step < kLeastStep) return std::nullopt;
  const Preconditioner p = preconditioner(rows, step);
  TallQr qr;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    qr.grams.push_back(orthogonal_gram(stretch(rows, ends, k), p.r0));
    all += qr.grams.back();
  }
  const auto u = upper_cholesky(all, rows.rows());
  if (!u) return std::nullopt;
  qr.r = *u * p.r0;
  for (std::size_t k = 0; with_grams && k < ends.size(); ++k)
    qr.grams[k] = restored_gram(qr.grams[k], p, stretch(rows, ends, k));
  return qr;
}

}  // namespace

TallQr tall_qr(const TallRows& rows, std::span<const Eigen::Index> ends) {
  const Eigen::Index all = rows.rows();
  assert(ends.empty() || ends.back() == all);
  const auto n_stretches = static_cast<Eigen::Index>(ends.size());
  const bool are_long = n_stretches > 0 && all >= kLongStretch * rows.cols() * n_stretches;
  auto qr = cholesky_qr(rows, are_long ? ends : std::span(&all, 1), are_long);
  if (qr && are_long) return *std::move(qr);
  TallQr plain{qr ? std::move(qr->r) : blocked_householder(rows), {}};
  for (std::size_t k = 0; k < ends.size(); ++k)
    plain.grams.push_back(plain_gram(stretch(rows, ends, k)));
  return plain;
}

}  // namespace cablefit
