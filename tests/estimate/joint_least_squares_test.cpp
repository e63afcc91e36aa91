// Several equations in one problem: numbers of Octave, equalities met to rounding, what no row
// determines, and robust variances by Monte Carlo.
#include "cablefit/estimate/fit/joint_least_squares.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

RowStatistics statistics_of(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  Eigen::MatrixXd rows(a.rows(), a.cols() + 1);
  rows << a, b;
  std::vector<Eigen::Index> numbers(static_cast<std::size_t>(a.rows()));
  std::iota(numbers.begin(), numbers.end(), 0);
  RowStatistics statistics(rows.cols(), rows.rows());
  statistics.add(rows, numbers);
  return statistics;
}

JointBlock block_of(const RowStatistics& rows, double weight, int record) {
  const Eigen::Index p = rows.n_columns() - 1;
  Eigen::MatrixXd regressors = Eigen::MatrixXd::Zero(p + 1, p);
  regressors.topRows(p).setIdentity();
  return {&rows, regressors, Eigen::VectorXd::Unit(p + 1, p), weight, record};
}

struct Octave {
  RowStatistics first, second;

  Octave() : first(5, 6), second(5, 5) {
    Eigen::MatrixXd a(6, 4);
    a << 1, 2, -0.5, 0.3, -1, 1, 3, 2, 2, 0.3, -1, 1, 0.7, -2, 1.5, -1, 1.2, 0.4, 0.9, 0.1, 0.2,
        0.8, -0.6, 1.4;
    first = statistics_of(a, Eigen::Vector<double, 6>(1, -2.5, 3, 0.4, 1.1, 2));
    a.resize(5, 4);
    a << 0.5, 0, 1, -1, 2, 1, 0, 0.4, -0.3, 0.6, 1.1, 0, 1, -1, 0.2, 0.7, 0, 2, -1, 1;
    second = statistics_of(a, Eigen::Vector<double, 5>(0.3, 1.7, -0.9, 2.2, 0.1));
  }
  JointProblem problem() const {
    JointProblem problem;
    problem.blocks = {block_of(first, 4, 0), block_of(second, 0.25, 1)};
    problem.names = {"a", "b", "c", "d"};
    problem.equalities = Eigen::RowVector4d(1, -1, 2, 0);
    return problem;
  }
};

// Octave 7.3: W = [2 a1; a2/2], Z = null([1 -1 2 0]), x = Z ((W Z) \ y); condition 5, so rounding
// stays below 1e-13.
TEST_CASE("a joint problem with an equality agrees with Octave", "[estimate]") {
  const Octave octave;
  const JointSolution s = solve(octave.problem());
  const Eigen::Vector4d x(1.094988632493954, -0.3313635701211483, -0.7131761013075509,
                          0.5692497489675601);
  const Eigen::Vector4d operator_diagonal(0.0179133698072134, 0.04848555814623792,
                                          0.01259378269456557, 0.06801898110742056);
  CHECK((s.x - x).norm() < 1e-13);
  CHECK(std::abs(s.x(0) - s.x(1) + 2 * s.x(2)) < 1e-15);
  CHECK((s.solve_operator.diagonal() - operator_diagonal).norm() < 1e-14);
  CHECK(std::abs(s.rss[0] - 1.445814197497455) < 1e-12);
  CHECK(std::abs(s.rss[1] - 1.928119741655139) < 1e-12);
  CHECK(std::abs(s.weighted_rss - 4 * s.rss[0] - 0.25 * s.rss[1]) < 1e-12);
  CHECK(s.n_params == 3);
}

// Octave 7.3: op (16 s1 a1'a1 + s2 a2'a2 / 16) op * 11/8, s the variance of each block's residual.
TEST_CASE("the white covariance of a joint problem takes each block's variance", "[estimate]") {
  const Octave octave;
  const JointProblem problem = octave.problem();
  const JointCovariance c = joint_covariance(problem, solve(problem));
  const Eigen::Vector4d white(0.02309346835482116, 0.05988750571566351, 0.01580306395892084,
                              0.08499653833798054);
  CHECK((c.white.diagonal() - white).norm() < 1e-13);
}

// qp(x0, W'W, -W'y, [1 -1 2 0], 0, [], [], [0;0], [0 1 1 0; 0 0 0 1], []) of Octave 7.3: both
// inequalities hold the solution, lambda 11.5 and 2.04.
TEST_CASE("a joint problem with inequalities agrees with Octave's qp", "[estimate]") {
  const Octave octave;
  JointProblem problem = octave.problem();
  problem.inequalities.resize(2, 4);
  problem.inequalities << 0, 1, 1, 0, 0, 0, 0, 1;
  const JointSolution s = solve(problem);
  const Eigen::Vector4d x(1.120778251130924, 0.3735927503769745, -0.3735927503769744, 0);
  CHECK((s.x - x).norm() < 1e-12);
  CHECK(s.active == std::vector<Eigen::Index>{0, 1});
  problem.inequalities *= -1;  // d <= 0 contradicts the data: d = 0; b + c <= 0 is met
  CHECK(solve(problem).active == std::vector<Eigen::Index>{1});
}

// Parameters 0 and 1 enter as their sum only.
TEST_CASE("a joint problem says which combinations the data determine", "[estimate]") {
  Normal normal(31);
  Eigen::MatrixXd a(40, 3);
  for (double& value : a.reshaped()) value = normal();
  a.col(1) = a.col(0);
  const RowStatistics rows = statistics_of(a, a * Eigen::Vector3d(1, 2, 3));
  JointProblem problem;
  problem.blocks = {block_of(rows, 1, 0)};
  problem.names = {"a", "b", "c"};
  const JointSolution s = solve(problem);
  CHECK(s.n_params == 2);
  CHECK_FALSE(s.determines(Eigen::Vector3d(1, 0, 0)));
  CHECK_FALSE(s.determines(Eigen::Vector3d(1, -1, 0)));
  CHECK(s.determines(Eigen::Vector3d(1, 1, 0)));
  CHECK(s.determines(Eigen::Vector3d(0, 0, 1)));
  CHECK(std::abs(s.x(0) + s.x(1) - 3) < 1e-12);
  problem.equalities = Eigen::RowVector3d(1, -2, 0);  // separates the two
  const JointSolution tied = solve(problem);
  CHECK(tied.determines(Eigen::Vector3d(1, 0, 0)));
  CHECK(std::abs(tied.x(0) - 2) < 1e-12);
}

/// A block of 400 rows: a common slope and an offset of its own, AR(1) noise.
struct Simulated {
  RowStatistics rows;
  explicit Simulated(Normal& normal, double rho, double sd) : rows(3, 1) {
    Eigen::MatrixXd a(400, 2);
    Eigen::VectorXd b(400);
    double noise = sd * normal();
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      a.row(i) << std::sin(0.05 * static_cast<double>(i)), 1;
      noise = rho * noise + std::sqrt(1 - rho * rho) * sd * normal();
      b(i) = 2 * a(i, 0) + 0.5 + noise;
    }
    rows = statistics_of(a, b);
  }
};

/// Mean square distance of the slope from the truth, and what the covariances say of it.
struct Spread {
  double seen = 0, robust = 0, white = 0;

  void add(const JointProblem& problem, double share) {
    const JointSolution s = solve(problem);
    const JointCovariance c = joint_covariance(problem, s);
    seen += share * (s.x(0) - 2) * (s.x(0) - 2);
    robust += share * c.covariance(0, 0);
    white += share * c.white(0, 0);
  }
};

// 400 problems of two blocks, one of them correlated over 10 rows: (1 + rho)/(1 - rho) = 9 times
// the variance of white noise for the constant, 7.9 times at the slope's frequency. With equal
// weights the slope's variance is (7.9 + 1)/4 of a block's white one, the white formula says 2/4;
// weighted it is 7.9/8.9. An estimate of the spread of 400 numbers has a relative sd of
// sqrt(2/400) = 7 %, and HAC on 400 cells is up to 10 % off (estimation-rules): 25 %.
TEST_CASE("joint variances and weights are honest about correlated blocks",
          "[estimate][monte-carlo]") {
  Normal normal(7300);
  constexpr int kRuns = 400;
  Spread equal, weighted;
  double inflation = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Simulated one(normal, 0.8, 1.0), two(normal, 0, 1.0);
    JointProblem problem;
    problem.names = {"slope", "first", "second"};
    problem.blocks = {{&one.rows, Eigen::MatrixXd::Zero(3, 3), Eigen::Vector3d(0, 0, 1), 1, 0},
                      {&two.rows, Eigen::MatrixXd::Zero(3, 3), Eigen::Vector3d(0, 0, 1), 1, 1}};
    problem.blocks[0].regressors(0, 0) = problem.blocks[0].regressors(1, 1) = 1;
    problem.blocks[1].regressors(0, 0) = problem.blocks[1].regressors(1, 2) = 1;
    equal.add(problem, 1.0 / kRuns);
    const JointSolution s = solve(problem);
    inflation += residual_inflation(problem.blocks[0], s.combinations[0]) / kRuns;
    reweigh(problem, s);
    weighted.add(problem, 1.0 / kRuns);
  }
  CHECK_THAT(equal.robust / equal.seen, Catch::WithinAbs(1, 0.25));
  CHECK_THAT(weighted.robust / weighted.seen, Catch::WithinAbs(1, 0.25));
  CHECK_THAT(equal.white / equal.seen, Catch::WithinAbs(2 / 8.9, 0.06));
  CHECK_THAT(weighted.seen / equal.seen, Catch::WithinAbs(4 * 7.9 / 8.9 / 8.9, 0.1));
  CHECK_THAT(inflation, Catch::WithinAbs(8.4, 2));
}

}  // namespace
