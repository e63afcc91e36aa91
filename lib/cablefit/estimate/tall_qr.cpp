#include "cablefit/estimate/tall_qr.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <optional>

#include "cablefit/estimate/tall_gram.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kStep = 16;          // every so many rows are the sample
constexpr Eigen::Index kRowsPerColumn = 8;  // in the sample; fewer rows do not stand for the rest
// Rows that stay near the processor; not a power of two, or all columns would fall on the same few
// lines of the first-level cache.
constexpr Eigen::Index kBlock = 248;
constexpr double kNull = 1e-7;    // diagonal of R0 over its column's norm: the column says nothing
constexpr double kSkewed = 0.05;  // smallest over largest diagonal of chol: about 1 / condition

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

std::optional<Eigen::MatrixXd> cholesky_qr(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  const Eigen::Index n = rows.cols(), n_sample = rows.rows() / kStep;
  if (n_sample < kRowsPerColumn * n) return std::nullopt;
  Eigen::MatrixXd sample(n_sample, n);
  for (Eigen::Index k = 0; k < n; ++k)
    for (Eigen::Index i = 0; i < n_sample; ++i) sample(i, k) = rows(i * kStep, k);
  const Eigen::MatrixXd r0 = householder(std::move(sample));
  for (Eigen::Index k = 0; k < n; ++k)
    if (!(std::abs(r0(k, k)) > kNull * r0.col(k).norm())) return std::nullopt;

  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd block;
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += kBlock) {
    block = rows.middleRows(begin, std::min(kBlock, rows.rows() - begin));
    divide_by_triangle(block, r0);
    add_gram(block, gram);
  }
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Upper> cholesky(gram);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXd u = cholesky.matrixU();
  if (!(u.diagonal().minCoeff() > kSkewed * u.diagonal().maxCoeff())) return std::nullopt;
  return u * r0;
}

}  // namespace

Eigen::MatrixXd tall_qr(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
  if (auto r = cholesky_qr(rows)) return *std::move(r);
  return blocked_householder(rows);
}

}  // namespace cablefit
