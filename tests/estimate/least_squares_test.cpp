// solve(): rank in words, bounds, the paper's covariance (25), correlations.
#include "cablefit/estimate/fit/least_squares.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

constexpr double kNone = -std::numeric_limits<double>::infinity();

struct Data {
  Eigen::MatrixXd w;  // n x p
  Eigen::VectorXd y;
};

LinearSolution fit(const Data& data, const std::vector<std::string>& names,
                   const std::vector<double>& lower = {}, bool with_cells = true) {
  const Eigen::Index p = data.w.cols();
  Eigen::MatrixXd rows(data.w.rows(), p + 1);
  rows << data.w, data.y;
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) numbers.push_back(i);
  RowStatistics statistics(p + 1, rows.rows(), with_cells);
  statistics.add(rows, numbers);
  LinearProblem problem;
  for (Eigen::Index k = 0; k < p; ++k) problem.regressors.push_back(k);
  problem.names = names;
  problem.lower = lower;
  problem.response = Eigen::VectorXd::Unit(p + 1, p);
  return solve(statistics, problem);
}

Data random_data(const Eigen::VectorXd& x, double noise, Eigen::Index n, std::uint64_t seed) {
  Normal normal(seed);
  Data data{Eigen::MatrixXd(n, x.size()), {}};
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < x.size(); ++k) data.w(i, k) = normal();
  data.y = data.w * x;
  for (double& y : data.y) y += noise * normal();
  return data;
}

TEST_CASE("the white covariance is the closed form sigma^2 (W'W)^-1", "[estimate]") {
  const Data data = random_data(Eigen::Vector3d(1, -2, 300), 0.5, 400, 6100);
  const LinearSolution s = fit(data, {"a", "b", "c"});
  const Eigen::Matrix3d inverse = (data.w.transpose() * data.w).inverse();
  const Eigen::Vector3d x = inverse * data.w.transpose() * data.y;
  const double rss = (data.y - data.w * x).squaredNorm();
  CHECK((s.x - x).norm() < 1e-12 * x.norm());
  CHECK_THAT(s.rss, Catch::WithinRel(rss, 1e-10));
  CHECK_THAT(s.rms(), Catch::WithinRel(std::sqrt(rss / 400), 1e-10));
  CHECK((s.covariance_white - rss / 397 * inverse).norm() < 1e-10 * s.covariance_white.norm());
  CHECK(s.n_params == 3);
  // White residuals: the robust sd is not far off, and never below.
  for (Eigen::Index k = 0; k < 3; ++k) {
    CHECK(s.covariance(k, k) >= s.covariance_white(k, k) * (1 - 1e-12));
    CHECK(s.covariance(k, k) < 1.5 * s.covariance_white(k, k));
  }
}

TEST_CASE("columns that cannot be told apart are named", "[estimate]") {
  Data data = random_data(Eigen::Vector4d(1, 2, 3, 4), 0.1, 200, 6101);
  data.w.col(2) = -0.7 * data.w.col(0);
  const LinearSolution s = fit(data, {"J_motor", "f_vm", "K", "offset"});
  CHECK(s.not_identifiable[0] ==
        "is not separable from K in these logs; K - 1.43 J_motor = -0.9438 +- 0.29 is "
        "determined");
  CHECK(s.not_identifiable[1].empty());
  CHECK(s.not_identifiable[2] ==
        "is not separable from J_motor in these logs; K - 1.43 J_motor = -0.9438 +- 0.29 is "
        "determined");
  CHECK(s.not_identifiable[3].empty());
  CHECK(s.n_params == 2);
  CHECK(std::isfinite(s.x(0)));

  data.w.col(2) = data.w.col(0) + data.w.col(1);
  const LinearSolution three = fit(data, {"a", "b", "c", "d"});
  CHECK(three.not_identifiable[0] == "is not separable from b, c in these logs");
  CHECK(three.not_identifiable[3].empty());
}

TEST_CASE("a column of zeros was never excited", "[estimate]") {
  Data data = random_data(Eigen::Vector2d(1, 2), 0.1, 200, 6102);
  data.w.col(1).setZero();
  const LinearSolution s = fit(data, {"a", "b"});
  CHECK(s.not_identifiable[1] == "its column is zero: the log never excites it");
  CHECK(s.not_identifiable[0].empty());
}

TEST_CASE("fewer rows than parameters is a result, not a crash", "[estimate]") {
  const LinearSolution s = fit(random_data(Eigen::Vector3d(1, 2, 3), 0, 2, 6103), {"a", "b", "c"});
  std::size_t refused = 0;
  for (const std::string& text : s.not_identifiable) refused += !text.empty();
  CHECK(refused == 3);
}

TEST_CASE("bounds are met and the others fitted again", "[estimate]") {
  const Data data = random_data(Eigen::Vector3d(-1, 2, -3), 0.1, 300, 6104);
  const LinearSolution s = fit(data, {"a", "b", "c"}, {0, 0, kNone});
  CHECK(s.at_bound == std::vector<bool>{true, false, false});
  CHECK(s.x(0) == 0);
  // The fit to the other two columns alone.
  const Eigen::MatrixXd w = data.w.rightCols(2);
  const Eigen::VectorXd x = (w.transpose() * w).inverse() * w.transpose() * data.y;
  CHECK((s.x.tail(2) - x).norm() < 1e-12 * x.norm());
  CHECK_THAT(s.unbounded_x(0), Catch::WithinAbs(-1, 0.05));
  CHECK(s.unbounded_sd(0) > 0);
  CHECK(s.n_params == 2);
  // Bounds that do not bind do nothing.
  const LinearSolution free = fit(data, {"a", "b", "c"});
  const LinearSolution loose = fit(data, {"a", "b", "c"}, {kNone, 0, kNone});
  CHECK((free.x - loose.x).norm() == 0);
}

TEST_CASE("estimates that lean on each other are told", "[estimate]") {
  Data data = random_data(Eigen::Vector2d(1, 2), 0.1, 500, 6105);
  Normal normal(6106);
  for (Eigen::Index i = 0; i < 500; ++i) data.w(i, 1) = data.w(i, 0) + 0.1 * normal();
  const LinearSolution s = fit(data, {"f_v", "f_s"});
  // Correlation of the regressors 1/sqrt(1.01) = 0.995, of the estimates the same with a minus.
  CHECK_THAT(s.correlation(0, 1), Catch::WithinAbs(-0.995, 0.002));
  REQUIRE(s.warnings.size() == 1);
  CHECK(s.warnings[0].find("f_v and f_s are strongly correlated: -0.99") == 0);
}

TEST_CASE("without cells the honest covariance is the white one", "[estimate]") {
  const Data data = random_data(Eigen::Vector2d(1, 2), 0.3, 300, 6107);
  const LinearSolution s = fit(data, {"a", "b"}, {}, false);
  CHECK((s.covariance - s.covariance_white).norm() == 0);
}

}  // namespace
