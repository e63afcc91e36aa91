// Recursive least squares with a forgetting factor: nothing forgotten is least squares; a step is
// followed with the memory's time constant; sd against closed forms and draws.
#include "cablefit/estimate/fit/recursive_trace.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;

/// Rows [w1 w2 y] with the model y = w x.
JointBlock plain_block(Eigen::Index p, double weight = 1) {
  JointBlock block;
  block.regressors = Eigen::MatrixXd::Identity(p + 1, p);
  block.response = Eigen::VectorXd::Unit(p + 1, p);
  block.weight = weight;
  return block;
}

Eigen::MatrixXd random_rows(Eigen::Index n, std::uint64_t seed) {
  test::Normal normal(seed);
  Eigen::MatrixXd rows(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = normal(), v = 100 * (0.5 * u + normal());
    rows.row(i) << u, v, 3 * u - 0.02 * v + 0.3 * normal();
  }
  return rows;
}

/// One row after the other.
void add_one_by_one(RecursiveInformation& information, const Eigen::MatrixXd& rows,
                    double forgetting) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    information.forget(forgetting);
    information.add(plain_block(rows.cols() - 1), rows.row(i));
  }
}

TEST_CASE("lambda = 1 is least squares", "[estimate]") {
  const Eigen::MatrixXd rows = random_rows(500, 41);
  RecursiveInformation information({"a", "b"}, Eigen::MatrixXd(0, 2));
  add_one_by_one(information, rows, 1);
  const TracePoint end = information.point("");
  const Eigen::VectorXd direct = rows.leftCols(2).colPivHouseholderQr().solve(rows.col(2));
  const Eigen::MatrixXd inverse = (rows.leftCols(2).transpose() * rows.leftCols(2)).inverse();
  for (std::size_t k = 0; k < 2; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    CHECK_THAT(end.value[k], Catch::WithinRel(direct(i), 1e-9));
    CHECK_THAT(end.sd[k], Catch::WithinRel(std::sqrt(inverse(i, i)), 1e-9));
  }
}

TEST_CASE("rows with weights at once are rows forgotten one by one", "[estimate]") {
  const Eigen::MatrixXd rows = random_rows(300, 42);
  constexpr double kForgetting = 0.97;
  RecursiveInformation one_by_one({"a", "b"}, Eigen::MatrixXd(0, 2)), at_once = one_by_one;
  add_one_by_one(one_by_one, rows, kForgetting);
  Eigen::VectorXd weights(300);
  for (Eigen::Index i = 0; i < 300; ++i) weights(i) = std::pow(kForgetting, 299 - i);
  at_once.add(plain_block(2), rows, weights);
  // Weighted least squares by the normal equations, two well-conditioned parameters.
  const Eigen::MatrixXd w = rows.leftCols(2), lw = weights.asDiagonal() * w;
  const Eigen::MatrixXd p = (w.transpose() * lw).inverse();
  const Eigen::VectorXd x = p * (lw.transpose() * rows.col(2));
  const Eigen::MatrixXd covariance = p * (lw.transpose() * lw) * p;
  const TracePoint a = one_by_one.point(""), b = at_once.point("");
  for (std::size_t k = 0; k < 2; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    CHECK_THAT(a.value[k], Catch::WithinRel(x(i), 1e-9));
    CHECK_THAT(b.value[k], Catch::WithinRel(x(i), 1e-9));
    CHECK_THAT(a.sd[k], Catch::WithinRel(std::sqrt(covariance(i, i)), 1e-9));
    CHECK_THAT(b.sd[k], Catch::WithinRel(a.sd[k], 1e-9));
  }
}

// Of a constant, x = sum lambda^age y / sum lambda^age: after n samples of a step from a to b,
// b + (a - b) lambda^n in the long run. With lambda = 1 - 1/N that is exp(-n/N) for a large N.
TEST_CASE("a step is followed with the time constant of the memory", "[estimate]") {
  for (const double memory : {20.0, 100.0}) {
    const double forgetting = forgetting_factor(memory);
    CHECK_THAT(1 / (1 - forgetting), Catch::WithinRel(memory, 1e-12));
    RecursiveInformation information({"level"}, Eigen::MatrixXd(0, 1));
    const auto feed = [&](double y, int n) {
      Eigen::MatrixXd rows(n, 2);
      rows.col(0).setOnes();
      rows.col(1).setConstant(y);
      add_one_by_one(information, rows, forgetting);
    };
    feed(5, static_cast<int>(40 * memory));  // the start is exp(-40)
    CHECK_THAT(information.point("").value[0], Catch::WithinRel(5.0, 1e-12));
    const int n = static_cast<int>(memory);
    feed(2, n);
    CHECK_THAT(information.point("").value[0] - 2,
               Catch::WithinRel(3 * std::pow(forgetting, n), 1e-9));
    CHECK_THAT(std::pow(forgetting, n), Catch::WithinRel(std::exp(-1.0), 0.03));
    feed(2, 2 * n);
    CHECK_THAT(information.point("").value[0] - 2,
               Catch::WithinRel(3 * std::pow(forgetting, 3 * n), 1e-8));
  }
}

// var = sigma^2 (1 - lambda)/(1 + lambda) of a constant: so many samples of one weight.
TEST_CASE("the sd of a forgetful estimate is its scatter", "[estimate]") {
  constexpr double kNoise = 0.7, kForgetting = 0.95;
  CHECK_THAT(equivalent_samples(kForgetting), Catch::WithinRel(39.0, 1e-12));
  constexpr int kRuns = 4000, kRows = 300;
  double squares = 0, sd = 0;
  Eigen::VectorXd weights(kRows);
  for (Eigen::Index i = 0; i < kRows; ++i) weights(i) = std::pow(kForgetting, kRows - 1 - i);
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    test::Normal normal(60000 + run);
    Eigen::MatrixXd rows(kRows, 2);
    for (Eigen::Index i = 0; i < kRows; ++i) rows.row(i) << 1, 4 + kNoise * normal();
    RecursiveInformation information({"level"}, Eigen::MatrixXd(0, 1));
    information.add(plain_block(1, 1 / (kNoise * kNoise)), rows, weights);
    const TracePoint end = information.point("");
    squares += (end.value[0] - 4) * (end.value[0] - 4) / kRuns;
    sd = end.sd[0];
  }
  const double expected = kNoise / std::sqrt(equivalent_samples(kForgetting));
  CHECK_THAT(sd, Catch::WithinRel(expected, 1e-6));  // 0.95^300 is left of the long run
  // The scatter of 4000 draws is known to 1/sqrt(8000) = 1.1 %.
  std::printf("  forgetful sd: %.5f, scatter of %d runs %.5f\n", sd, kRuns, std::sqrt(squares));
  CHECK_THAT(std::sqrt(squares), Catch::WithinRel(expected, 0.035));
}

}  // namespace
