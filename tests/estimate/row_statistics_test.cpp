// The streamed QR and the Gram cells against everything at once.
#include "cablefit/estimate/solve/row_statistics.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

Eigen::MatrixXd random_rows(Eigen::Index n, Eigen::Index columns, std::uint64_t seed) {
  Normal normal(seed);
  Eigen::MatrixXd rows(n, columns);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < columns; ++k)
      rows(i, k) = std::pow(10.0, static_cast<double>(k) - 2) * (normal() + 0.3);
  return rows;
}

/// R with a positive diagonal: unique.
Eigen::MatrixXd unique(const Eigen::MatrixXd& r) {
  return r.diagonal().cwiseSign().asDiagonal() * r;
}

TEST_CASE("the streamed R is that of one QR of 100000 rows", "[estimate]") {
  const Eigen::MatrixXd rows = random_rows(100000, 7, 6000);
  const Eigen::MatrixXd whole = unique(
      Eigen::MatrixXd(rows.householderQr().matrixQR().topRows(7).triangularView<Eigen::Upper>()));
  const Eigen::MatrixXd gram = rows.transpose() * rows;
  for (const Eigen::Index block : {1L << 20, 8192L, 1000L, 37L}) {
    StreamingQr qr(7);
    for (Eigen::Index begin = 0; begin < rows.rows(); begin += block)
      qr.add(rows.middleRows(begin, std::min(block, rows.rows() - begin)));
    INFO("blocks of " << block);
    for (Eigen::Index k = 0; k < 7; ++k) {
      const double scale = whole.col(k).norm();
      // Rounding of 1e5 rows in sums of squares: sqrt(n) eps = 7e-14.
      CHECK((unique(qr.r()).col(k) - whole.col(k)).norm() < 1e-12 * scale);
      const Eigen::VectorXd product = qr.r().transpose() * qr.r().col(k);
      for (Eigen::Index j = 0; j < 7; ++j)
        CHECK(std::abs(product(j) - gram(j, k)) < 1e-12 * scale * whole.col(j).norm());
    }
  }
}

TEST_CASE("accumulators of windows add up to one", "[estimate]") {
  const Eigen::MatrixXd rows = random_rows(10000, 4, 6001);
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) numbers.push_back(i + i / 100);  // with holes
  RowStatistics one(4, rows.rows());
  one.add(rows, numbers);
  RowStatistics total(4, rows.rows());
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += 777) {
    const Eigen::Index n = std::min<Eigen::Index>(777, rows.rows() - begin);
    RowStatistics part = total.empty_copy();
    part.add(rows.middleRows(begin, n), std::span(numbers).subspan(static_cast<std::size_t>(begin),
                                                                   static_cast<std::size_t>(n)));
    total.add(std::move(part));
  }
  CHECK(total.n_rows() == 10000);
  REQUIRE(total.cells().size() == one.cells().size());
  CHECK(one.cell_rows() == 5);  // 10000 rows in at most 2048 cells
  CHECK(one.cells().size() <= RowStatistics::kMaxCells);
  Eigen::Index counted = 0;
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(4, 4);
  for (std::size_t k = 0; k < one.cells().size(); ++k) {
    const GramCell& a = one.cells()[k];
    const GramCell& b = total.cells()[k];
    CHECK(a.id == b.id);
    CHECK(a.n_rows == b.n_rows);
    CHECK((a.gram - b.gram).norm() <= 1e-14 * a.gram.norm());
    counted += a.n_rows;
    sum += a.gram;
  }
  CHECK(counted == 10000);
  CHECK((sum - one.r().transpose() * one.r()).norm() < 1e-12 * sum.norm());
  // A cell is a stretch of time: the rows with these numbers and no others.
  const GramCell& cell = one.cells().at(40);
  Eigen::MatrixXd direct = Eigen::MatrixXd::Zero(4, 4);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (numbers[static_cast<std::size_t>(i)] / one.cell_rows() == cell.id)
      direct += rows.row(i).transpose() * rows.row(i);
  CHECK((direct - cell.gram).norm() < 1e-13 * direct.norm());
}

// Gram matrices of cells are formed from nearly orthogonal rows. They must be exact also where a
// column depends on others, or is zero.
TEST_CASE("long cells have the Gram matrices of their rows", "[estimate]") {
  Eigen::MatrixXd rows = random_rows(30000, 7, 6003);
  rows.col(3) = 2 * rows.col(0) - 0.01 * rows.col(2);
  rows.col(5).setZero();
  rows.col(6).segment(3 * 1465, 1465).setZero();  // in one cell alone
  rows.col(4).segment(5 * 1465, 1465) *= 1e-9;
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) numbers.push_back(i);
  RowStatistics statistics(7, 3000000);
  REQUIRE(statistics.cell_rows() == 1465);
  for (Eigen::Index begin = 0; begin < rows.rows(); begin += 8192) {
    const Eigen::Index n = std::min<Eigen::Index>(8192, rows.rows() - begin);
    statistics.add(
        rows.middleRows(begin, n),
        std::span(numbers).subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(n)));
  }
  REQUIRE(statistics.cells().size() == 21);
  for (const GramCell& cell : statistics.cells()) {
    const auto own = rows.middleRows(cell.id * 1465, cell.n_rows);
    const Eigen::MatrixXd direct = own.transpose() * own;
    for (Eigen::Index i = 0; i < 7; ++i)
      for (Eigen::Index j = 0; j < 7; ++j) {
        const double scale = own.col(i).norm() * own.col(j).norm();
        CHECK(std::abs(cell.gram(i, j) - direct(i, j)) <= 1e-13 * scale);
        CHECK(cell.gram(i, j) == cell.gram(j, i));
      }
  }
}

TEST_CASE("without cells there are none", "[estimate]") {
  RowStatistics rows(3, 100, false);
  const std::vector<Eigen::Index> numbers = {0, 1, 2, 3, 4};
  rows.add(random_rows(5, 3, 6002), numbers);
  CHECK(rows.cells().empty());
  CHECK(rows.n_rows() == 5);
  CHECK(rows.empty_copy().n_rows() == 0);
}

TEST_CASE("weighted rows of two equations are their scaled rows under each other", "[estimate]") {
  const Eigen::MatrixXd first = random_rows(600, 4, 6010), second = random_rows(500, 4, 6011);
  std::vector<Eigen::Index> every, some;
  for (Eigen::Index i = 0; i < 600; ++i) every.push_back(i);
  for (Eigen::Index i = 0; i < 500; ++i) some.push_back(i + 80);
  RowStatistics a(4, 20000), b = a.empty_copy();
  a.add(first, every);
  b.add(second, some);
  const std::vector<const RowStatistics*> equations = {&a, &b};
  const std::vector<double> weights = {0.25, 9};
  const RowStatistics both = RowStatistics::weighted(equations, weights);
  Eigen::MatrixXd stacked(1100, 4);
  stacked << 0.5 * first, 3 * second;
  CHECK(both.n_rows() == 1100);
  const Eigen::MatrixXd gram = stacked.transpose() * stacked;
  // Rounding of 1e3 products: sqrt(n) eps = 7e-15.
  CHECK((both.r().transpose() * both.r() - gram).norm() < 1e-13 * gram.norm());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(4, 4);
  Eigen::Index rows = 0, last = -1;
  for (const GramCell& cell : both.cells()) {
    CHECK(cell.id > last);  // one cell per stretch of time
    last = cell.id;
    sum += cell.gram;
    rows += cell.n_rows;
  }
  CHECK(rows == 1100);
  CHECK((sum - gram).norm() < 1e-13 * gram.norm());
  CHECK(both.cells().front().n_rows == a.cell_rows());  // before the second begins
}

}  // namespace
