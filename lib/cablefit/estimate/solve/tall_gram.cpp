#include "cablefit/estimate/solve/tall_gram.hpp"

#include <algorithm>

#include "cablefit/base/lanes.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kChunk = 256;  // rows whose columns stay in the first-level cache together

/// Products of two columns with two others: each value loaded serves two of them.
struct Tile {
  double aa = 0, ab = 0, ba = 0, bb = 0;
};
Tile tile(const double* a0, const double* a1, const double* b0, const double* b1, Eigen::Index n) {
  Lanes aa, ab, ba, bb;
  Tile t;
  Eigen::Index i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const Lanes x0 = load(a0 + i), x1 = load(a1 + i), y0 = load(b0 + i), y1 = load(b1 + i);
    aa.add_product(x0, y0);
    ab.add_product(x0, y1);
    ba.add_product(x1, y0);
    bb.add_product(x1, y1);
  }
  for (; i < n; ++i) {
    t.aa += a0[i] * b0[i];
    t.ab += a0[i] * b1[i];
    t.ba += a1[i] * b0[i];
    t.bb += a1[i] * b1[i];
  }
  t.aa += aa.sum();
  t.ab += ab.sum();
  t.ba += ba.sum();
  t.bb += bb.sum();
  return t;
}

void add_chunk(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& gram) {
  const Eigen::Index n = rows.rows(), p = rows.cols();
  const auto column = [&](Eigen::Index k) { return rows.col(k).data(); };
  for (Eigen::Index j = 0; j + 1 < p; j += 2) {
    for (Eigen::Index i = 0; i < j; i += 2) {
      const Tile t = tile(column(i), column(i + 1), column(j), column(j + 1), n);
      gram(i, j) += t.aa;
      gram(i, j + 1) += t.ab;
      gram(i + 1, j) += t.ba;
      gram(i + 1, j + 1) += t.bb;
    }
    gram(j, j) += dot(column(j), column(j), n);
    gram(j, j + 1) += dot(column(j), column(j + 1), n);
    gram(j + 1, j + 1) += dot(column(j + 1), column(j + 1), n);
  }
  if (p % 2 == 1)
    for (Eigen::Index i = 0; i < p; ++i) gram(i, p - 1) += dot(column(i), column(p - 1), n);
}

/// Four rows of rows r^-1, `stride` from column to column; `over` is 1 / diagonal of r.
void divide_lanes(double* rows, Eigen::Index stride, const Eigen::MatrixXd& r,
                  const Eigen::VectorXd& over) {
  for (Eigen::Index k = 0; k < r.cols(); ++k) {
    double* const to = rows + k * stride;
    const double* const factors = r.col(k).data();
    Lanes y = load(to);
    for (Eigen::Index i = 0; i < k; ++i) {
      const Lanes x = load(rows + i * stride);
      y += scaled(x, -factors[i]);
    }
    store(scaled(y, over(k)), to);
  }
}

}  // namespace

void divide_by_triangle(Eigen::MatrixXd& rows, const Eigen::MatrixXd& r) {
  const Eigen::VectorXd over = r.diagonal().cwiseInverse();
  const Eigen::Index n = rows.rows(), n_lanes = n - n % kLanes;
  for (Eigen::Index i = 0; i < n_lanes; i += kLanes) divide_lanes(rows.data() + i, n, r, over);
  for (Eigen::Index i = n_lanes; i < n; ++i)
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
      rows(i, k) = (rows(i, k) - rows.row(i).head(k).dot(r.col(k).head(k))) * over(k);
}

void add_gram(const Eigen::Ref<const Eigen::MatrixXd>& rows, Eigen::MatrixXd& gram) {
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += kChunk)
    add_chunk(rows.middleRows(begin, std::min(kChunk, rows.rows() - begin)), gram);
}

}  // namespace cablefit
