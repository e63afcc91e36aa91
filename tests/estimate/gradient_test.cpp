// The normalised gradient: its bound, its time constant, its scatter, and least squares at the end.
#include "cablefit/estimate/fit/gradient.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;

constexpr double kUnitOf[] = {1, 100, 0.01};  // columns of very different sizes

Eigen::MatrixXd exciting_rows(Eigen::Index n, std::uint64_t seed) {
  test::Normal normal(seed);
  Eigen::MatrixXd rows(n, 3);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) rows(i, j) = kUnitOf[j] * normal();
  return rows;
}

const Eigen::Vector3d kTrueValues(2, 0.03, -150);
const Eigen::Vector3d kColumnRms(kUnitOf[0], kUnitOf[1], kUnitOf[2]);

/// In sd of the columns, so that all parameters count alike.
double distance(const Eigen::VectorXd& x) {
  return (x - kTrueValues).cwiseProduct(kColumnRms).norm();
}

TEST_CASE("the gradient converges to least squares on exciting rows", "[estimate]") {
  const Eigen::MatrixXd rows = exciting_rows(4000, 50);
  const Eigen::VectorXd y = rows * kTrueValues;
  const Eigen::VectorXd direct = rows.colPivHouseholderQr().solve(y);
  NormalisedGradient gradient(kColumnRms, 0.5);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) gradient.add(rows.row(i), y(i));
  for (Eigen::Index k = 0; k < 3; ++k)
    CHECK_THAT(gradient.x()(k), Catch::WithinRel(direct(k), 1e-9));
}

// Each row's own error becomes (1 - step) of it; the bound in steps of D^2 w e is 2/(w'D^2 w),
// which for rows of one length is 2/trace of their second moments.
TEST_CASE("the gradient is stable below a step of two, and not beyond", "[estimate]") {
  const Eigen::MatrixXd rows = exciting_rows(3000, 51);
  const Eigen::VectorXd y = rows * kTrueValues;
  for (const double step : {0.2, 1.0, 1.9, 2.1, 2.5}) {
    INFO("step " << step);
    NormalisedGradient gradient(kColumnRms, step);
    gradient.add(rows.row(0), y(0));
    const double own = y(0) - rows.row(0).dot(gradient.x());
    CHECK(std::abs(own - (1 - step) * y(0)) < 1e-12 * std::abs(y(0)));
    for (Eigen::Index i = 1; i < rows.rows(); ++i) gradient.add(rows.row(i), y(i));
    if (step < 2)
      CHECK(distance(gradient.x()) < 1e-9);
    else
      CHECK(distance(gradient.x()) > 1e6);
  }
  CHECK(gradient_step(4, 400) == 0.01);
  CHECK(gradient_step(4, 2) == 1);  // limited, far below the bound
}

// The mean error along an eigenvector falls by exp(-1) in p/(step lambda) rows: rows of one length
// in the directions of the axes, so that lambda = 1 and the product is exact: (1 - step)^(n/p).
TEST_CASE("the gradient's time constant is that of its step", "[estimate]") {
  constexpr double kMemory = 60;
  const double step = gradient_step(3, kMemory);
  NormalisedGradient gradient(kColumnRms, step);
  for (int i = 0; i < static_cast<int>(kMemory); ++i) {
    Eigen::RowVector3d w = Eigen::RowVector3d::Zero();
    w(i % 3) = kUnitOf[i % 3];
    gradient.add(w, w.dot(kTrueValues));
  }
  const double left = std::pow(1 - step, kMemory / 3);
  for (Eigen::Index k = 0; k < 3; ++k)
    CHECK_THAT(1 - gradient.x()(k) / kTrueValues(k), Catch::WithinRel(left, 1e-9));
  CHECK_THAT(left, Catch::WithinRel(std::exp(-1.0), 0.03));
}

// Two columns with correlation rho: eigenvalues 1 - rho and 1 + rho.
TEST_CASE("correlated columns slow the gradient down", "[estimate]") {
  for (const double rho : {0.0, 0.6, 0.98}) {
    Eigen::Matrix2d moments;
    moments << 1, 30 * rho, 30 * rho, 900;
    const Eigen::MatrixXd r = moments.llt().matrixU();
    CHECK_THAT(slowest_direction(r), Catch::WithinRel(1 / (1 - rho), 1e-9));
  }
  Eigen::MatrixXd held(2, 2);
  held << 1, 0, 2, 0;
  CHECK(slowest_direction(held) == Approx(1));
}

TEST_CASE("the gradient's sd is its scatter for a small step", "[estimate]") {
  constexpr double kNoise = 0.5, kStep = 0.02;
  constexpr int kRuns = 400, kRows = 1500;  // 10 time constants of 150 rows
  Eigen::Vector3d squares = Eigen::Vector3d::Zero(), sd;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    // Rows of one length, as the closed form has p in place of the mean of 1/(w'D^2 w).
    Eigen::MatrixXd rows = exciting_rows(kRows, 8000 + run);
    for (Eigen::Index i = 0; i < kRows; ++i)
      rows.row(i) *= std::sqrt(3.0) / rows.row(i).transpose().cwiseQuotient(kColumnRms).norm();
    test::Normal normal(90000 + run);
    NormalisedGradient gradient(kColumnRms, kStep);
    for (Eigen::Index i = 0; i < kRows; ++i)
      gradient.add(rows.row(i), rows.row(i).dot(kTrueValues) + kNoise * normal());
    squares += (gradient.x() - kTrueValues).cwiseAbs2() / kRuns;
    sd = gradient.steady_sd(kNoise);
  }
  // 400 draws: 3.5 % each; the transient has left exp(-10) of 3.
  for (Eigen::Index k = 0; k < 3; ++k) {
    INFO("parameter " << k << ": sd " << sd(k) << ", scatter " << std::sqrt(squares(k)));
    CHECK_THAT(std::sqrt(squares(k)), Catch::WithinRel(sd(k), 0.12));
  }
}

TEST_CASE("a held parameter stays at 0", "[estimate]") {
  NormalisedGradient gradient(Eigen::Vector2d(1, 0), 0.5);
  for (int i = 0; i < 50; ++i) gradient.add(Eigen::RowVector2d(1, 7), 3);
  CHECK(gradient.x()(1) == 0);
  CHECK(gradient.x()(0) == Approx(3));
  CHECK(gradient.steady_sd(1)(1) == 0);
}

}  // namespace
