// Intervals by profile: closed forms where there is one inequality, a grid where there are two
// parameters, coverage at and near a bound, and what solve()'s solutions get.
#include "cablefit/estimate/fit/profile_interval.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/estimate/fit/derived_quantity.hpp"
#include "cablefit/estimate/fit/joint_least_squares.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

const Eigen::MatrixXd kNoBounds(0, 2);

Eigen::RowVectorXd first_of(Eigen::Index p) { return Eigen::RowVectorXd::Unit(p, 0); }

/// a with (a'a)^-1 = {{1, rho}, {rho, 1}}: estimates of sd 1 whose correlation is rho.
Eigen::Matrix2d correlated(double rho) {
  Eigen::Matrix2d covariance;
  covariance << 1, rho, rho, 1;
  return covariance.inverse().llt().matrixU();
}

// The profile of a free parameter is a parabola: ends at value -+ sqrt(threshold) sd, to 1e-6 of
// it.
TEST_CASE("without inequalities the profile's interval is value -+ t sd", "[estimate]") {
  const Eigen::Matrix2d a = correlated(0.8);
  const Eigen::Vector2d x(3, -2);
  const ProfileInterval i = profile_interval(a, a * x, kNoBounds, first_of(2), 4);
  CHECK_THAT(i.low, Catch::WithinAbs(1, 1e-5));
  CHECK_THAT(i.high, Catch::WithinAbs(5, 1e-5));
  const Eigen::RowVector2d sum(1, 1);  // variance 2 (1 + rho)
  const ProfileInterval of_sum = profile_interval(a, a * x, kNoBounds, sum, 4);
  CHECK_THAT(of_sum.high, Catch::WithinAbs(1 + 2 * std::sqrt(3.6), 1e-5));
}

// Free at -f it costs (v + f)^2 - f^2 to be at v >= 0.
TEST_CASE("at a bound the profile's interval is one-sided", "[estimate]") {
  const Eigen::Matrix2d a = correlated(0);
  const Eigen::MatrixXd bound = Eigen::RowVector2d(1, 0);
  for (const double f : {0.0, 0.3, 1.0, 4.0}) {
    const ProfileInterval i =
        profile_interval(a, a * Eigen::Vector2d(-f, 1), bound, first_of(2), 4);
    CHECK_THAT(i.low, Catch::WithinAbs(0, 1e-4));
    CHECK_THAT(i.high, Catch::WithinAbs(std::hypot(f, 2) - f, 1e-4));
  }
  // Inside, but nearer to the bound than the interval is long.
  const ProfileInterval near =
      profile_interval(a, a * Eigen::Vector2d(0.5, 1), bound, first_of(2), 4);
  CHECK_THAT(near.low, Catch::WithinAbs(0, 1e-4));
  CHECK_THAT(near.high, Catch::WithinAbs(2.5, 1e-4));
}

/// Ends of {v : least over x2 >= 0 of |a (v, x2) - b|^2 <= least + 4} by a grid of 1e-3.
ProfileInterval by_grid(const Eigen::Matrix2d& a, const Eigen::Vector2d& b) {
  const auto least_at = [&](double v) {
    const double free = a.col(1).dot(b - v * a.col(0)) / a.col(1).squaredNorm();
    return (v * a.col(0) + std::max(0.0, free) * a.col(1) - b).squaredNorm();
  };
  double least = 1e300;
  for (double v = -20; v < 20; v += 1e-3) least = std::min(least, least_at(v));
  ProfileInterval i{20, -20};
  for (double v = -20; v < 20; v += 1e-3)
    if (least_at(v) <= least + 4) i = {std::min(i.low, v), std::max(i.high, v)};
  return i;
}

// What a parameter trades with one on its bound makes its interval uneven.
TEST_CASE("beside a bound the profile agrees with a grid", "[estimate]") {
  const Eigen::MatrixXd bound = Eigen::RowVector2d(0, 1);
  for (const double rho : {-0.9, 0.5})
    for (const double beyond : {-3.0, -1.0, 0.5}) {
      const Eigen::Matrix2d a = correlated(rho);
      const Eigen::Vector2d b = a * Eigen::Vector2d(1, beyond);
      const ProfileInterval i = profile_interval(a, b, bound, first_of(2), 4);
      const ProfileInterval expected = by_grid(a, b);
      INFO(rho << " " << beyond);
      CHECK_THAT(i.low, Catch::WithinAbs(expected.low, 2e-3));
      CHECK_THAT(i.high, Catch::WithinAbs(expected.high, 2e-3));
    }
}

TEST_CASE("a threshold of nothing leaves the estimate alone", "[estimate]") {
  Eigen::Matrix2d a = Eigen::Matrix2d::Identity();
  const ProfileInterval i = profile_interval(a, Eigen::Vector2d(1, 0), kNoBounds, first_of(2), 0);
  CHECK(i.low == Approx(1));
  CHECK(i.high == Approx(1));
}

// Self & Liang 1987: the chi-squared quantile is safe at a bound. Four binomial sd of 4000 runs
// below 95 %: 93.6 %. At 0 and in the first sd it covers more, as it should: a symmetric interval
// of 1.96 sd about max(0, x) covers 97.5 % at 0 and 95 % from 1.96 sd on.
TEST_CASE("profile intervals cover at a bound and near it", "[estimate][monte-carlo]") {
  Normal normal(1701);
  const Eigen::MatrixXd a = Eigen::MatrixXd::Identity(1, 1), bound = a;
  const double threshold = 1.959964 * 1.959964;
  for (const double truth : {0.0, 0.5, 1.0, 1.96, 3.0}) {
    int covered = 0;
    for (int run = 0; run < 4000; ++run) {
      const Eigen::VectorXd b = Eigen::VectorXd::Constant(1, truth + normal());
      const ProfileInterval i = profile_interval(a, b, bound, first_of(1), threshold);
      covered += i.low <= truth + 1e-4 && truth <= i.high;
    }
    INFO("true value " << truth << " sd above the bound");
    CHECK(covered >= 3745);
  }
}

struct OnBound {
  RowStatistics rows{3, 400};
  LinearProblem problem;
};

/// y = 2 x1 - 0.05 x2 + noise, x2 >= 0; the noise an AR(1) of `rho`.
OnBound on_bound(double rho) {
  Normal normal(1702);
  Eigen::MatrixXd rows(400, 3);
  std::vector<Eigen::Index> numbers;
  double noise = 0;
  for (int i = 0; i < 400; ++i) {
    noise = rho * noise + normal();
    rows.row(i) << std::sin(0.31 * i), 1, 0;
    rows(i, 2) = 2 * rows(i, 0) - 0.5 + noise;
    numbers.push_back(i);
  }
  OnBound out;
  out.rows.add(rows, numbers);
  out.problem.regressors = {0, 1};
  out.problem.names = {"a", "b"};
  out.problem.lower = {-kUnbounded, 0};
  out.problem.response = Eigen::Vector3d(0, 0, 1);
  return out;
}

TEST_CASE("a solution on its bound gets profiles with the honest scale", "[estimate]") {
  for (const double rho : {0.0, 0.8}) {
    const OnBound c = on_bound(rho);
    LinearSolution s = solve(c.rows, c.problem);
    REQUIRE(s.at_bound[1]);
    s.profile = profile_intervals(c.rows, c.problem, s, true);
    const Estimate e = estimate_of({"b", "b", "N m", "", 0}, Axes::rotary, s, 1, {});
    CHECK(e.profiled);
    CHECK(e.ci_low == 0);
    CHECK(e.ci_high > 0);
    CHECK(e.ci_high < t_quantile_975(s.degrees_of_freedom) * e.sd);
    const std::vector<ProfileInterval> white = profile_intervals(c.rows, c.problem, s, false);
    // The constant's variance under an AR(1) is (1 + rho) / (1 - rho) times the white one: 9.
    const double longer = s.profile[1].high / white[1].high;
    INFO(rho << ": " << longer);
    CHECK((rho == 0 ? longer < 1.3 : longer > 3));
    CHECK(profile_intervals(c.rows, {{0, 1}, {"a", "b"}, {}, c.problem.response},
                            solve(c.rows, {{0, 1}, {"a", "b"}, {}, c.problem.response}), true)
              .empty());
  }
}

// y = 2 x1 + noise; x2 is all but x1, so that the logs determine only the sum of a and b. The
// constraint b >= 0 makes the sd of a small.
TEST_CASE("a value that only a bound determines has an interval far beyond its sd", "[estimate]") {
  Normal normal(1703);
  Eigen::MatrixXd rows(400, 3);
  std::vector<Eigen::Index> numbers;
  for (int i = 0; i < 400; ++i) {
    rows(i, 0) = std::sin(0.31 * i);
    rows(i, 1) = rows(i, 0) + 1e-5 * std::cos(0.31 * i);
    rows(i, 2) = 2 * rows(i, 0) - 0.01 * std::cos(0.31 * i) + normal();
    numbers.push_back(i);
  }
  RowStatistics statistics(3, 400);
  statistics.add(rows, numbers);
  LinearProblem problem{{0, 1}, {"a", "b"}, {}, Eigen::Vector3d(0, 0, 1)};
  problem.constraints = Eigen::RowVector2d(0, 1);
  LinearSolution s = solve(statistics, problem);
  REQUIRE_FALSE(s.active_constraints.empty());
  const auto a_of = [&] {
    return estimate_of({"a", "a", "N m", "", -kUnbounded}, Axes::rotary, s, 0, {});
  };
  const Estimate given_bound = a_of();
  CHECK(given_bound.value == Approx(2).margin(5 * given_bound.sd));
  CHECK(given_bound.sd < 0.2);
  s.profile = profile_intervals(statistics, problem, s, true);
  CHECK_FALSE(is_held_by_bounds(given_bound, s.degrees_of_freedom));
  const Estimate a = a_of();
  CHECK(a.ci_low < -100);
  CHECK(is_held_by_bounds(a, s.degrees_of_freedom));
}

// Of one block and one bound the joint problem is the linear one; its HAC is of the residual of the
// fit without bounds, the other's of the one with: 20 %.
TEST_CASE("profiles of a joint problem agree with those of one equation", "[estimate]") {
  const OnBound c = on_bound(0);
  LinearSolution s = solve(c.rows, c.problem);
  const ProfileInterval one = profile_intervals(c.rows, c.problem, s, false)[1];
  JointProblem joint;
  JointBlock block;
  block.rows = &c.rows;
  block.regressors = Eigen::MatrixXd::Zero(3, 2);
  block.regressors(0, 0) = block.regressors(1, 1) = 1;
  block.response = c.problem.response;
  joint.blocks = {block};
  joint.names = c.problem.names;
  joint.inequalities = Eigen::RowVector2d(0, 1);
  const ProfileInterval two = joint_profiles(joint)[1];
  CHECK_THAT(two.low, Catch::WithinAbs(0, 1e-3));
  CHECK_THAT(two.high, Catch::WithinRel(one.high, 0.2));
}

// Linear: exact. Curved: sd(1/x) = sd(x)/x^2 to second order, (sd/x)^2 = 1e-4.
TEST_CASE("derived quantities by the delta method", "[estimate]") {
  JointEstimates from{{"a", "b"}, Eigen::Vector2d(4, -1), Eigen::Matrix2d::Zero(), 1e9};
  from.covariance << 0.0016, 0.0003, 0.0003, 0.0009;
  CHECK(from.find("b") == 1);
  CHECK(from.find("c") == -1);
  const Estimate sum =
      derive({"sum", "sum", "N", [](const Eigen::VectorXd& v) { return 2 * v(0) + v(1); }}, from);
  CHECK(sum.value == 7);
  CHECK_THAT(sum.sd, Catch::WithinRel(std::sqrt(4 * 0.0016 + 4 * 0.0003 + 0.0009), 1e-9));
  CHECK_THAT(sum.ci_high, Catch::WithinRel(7 + 1.959964 * sum.sd, 1e-6));
  const Estimate inverse =
      derive({"1/a", "1/a", "1/N", [](const Eigen::VectorXd& v) { return 1 / v(0); }}, from);
  CHECK_THAT(inverse.sd, Catch::WithinRel(0.04 / 16, 2e-4));
}

}  // namespace
