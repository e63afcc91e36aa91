// Least squares under inequalities: numbers of Octave, the conditions of Karush, Kuhn and Tucker on
// random problems, and what solve() makes of active constraints.
#include "cablefit/estimate/solve/constrained_least_squares.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"
#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, Normal& normal) {
  Eigen::MatrixXd m(rows, columns);
  for (double& value : m.reshaped()) value = normal();
  return m;
}

struct Octave {
  Eigen::Matrix<double, 6, 4> a;
  Eigen::Vector<double, 6> b;
  Eigen::Matrix<double, 5, 4> g;
};

Octave octave() {
  Octave o;
  o.a << 1, 2, -0.5, 0.3, -1, 1, 3, 2, 2, 0.3, -1, 1, 0.7, -2, 1.5, -1, 1.2, 0.4, 0.9, 0.1, 0.2,
      0.8, -0.6, 1.4;
  o.b << 1, -2.5, 3, 0.4, 1.1, 2;
  o.g << 1, 0, 0, 0, 0.2, 0.5, 0.25, 0, 0, 0, 1, 1, -1, 1, 1, 1, 0, 1, -1, 0.5;
  return o;
}

// x = lsqnonneg(a, b) of Octave 7.3; both solve by QR, condition 3: rounding stays below 1e-13.
TEST_CASE("non-negative least squares agrees with Octave's lsqnonneg", "[estimate]") {
  const Octave o = octave();
  const Eigen::Vector4d expected(1.442910915934756, 0, 0, 0.1004962779156328);
  CHECK((non_negative_least_squares(o.a, o.b) - expected).norm() < 1e-13);
  Eigen::Matrix<double, 5, 3> a;
  a << 1, 2, 0.5, -1, 1, 3, 2, 0.3, -1, 0.7, -2, 1.5, 1.2, 0.4, 0.9;
  const Eigen::Vector<double, 5> b(-1, 2.5, -3, 0.4, 1.1);
  const Eigen::Vector3d one(0, 0, 0.8707738542449287);
  CHECK((non_negative_least_squares(a, b) - one).norm() < 1e-13);
}

// [x, ~, ~, lambda] = qp(x0, a'*a, -a'*b, [], [], [], [], zeros(5,1), g, []) of Octave 7.3, which
// squares the condition number: 1e-12 is generous for it.
TEST_CASE("constrained least squares agrees with Octave's qp", "[estimate]") {
  const Octave o = octave();
  const ConstrainedSolution s = constrained_least_squares(o.a, o.b, o.g);
  const Eigen::Vector4d expected(0.5740949059193368, 0.1304451406296251, -0.3640865945523345,
                                 0.8077363598420464);
  CHECK((s.x - expected).norm() < 1e-12);
  CHECK(s.active == std::vector<Eigen::Index>{3});
  CHECK_THAT(s.multipliers(3), Catch::WithinAbs(5.544227466706352, 1e-12));
}

/// Gradient = g' multipliers, multipliers >= 0, g x >= 0, and one of each pair is 0. Errors of a
/// backward stable solution: some 100 operations of 1e-16 each, times the condition number.
void check_kkt(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const Eigen::MatrixXd& g,
               const ConstrainedSolution& s, double condition) {
  const double tolerance = 1e-14 * condition;
  const Eigen::VectorXd norm = a.colwise().norm();
  const Eigen::VectorXd gradient = a.transpose() * (a * s.x - b) - g.transpose() * s.multipliers;
  CHECK(gradient.cwiseQuotient(norm).norm() < tolerance * b.norm());
  CHECK(s.multipliers.minCoeff() >= 0);
  for (Eigen::Index i = 0; i < g.rows(); ++i) {
    const double size = g.row(i).cwiseAbs().dot((b.norm() * norm.cwiseInverse()));
    const double slack = g.row(i).dot(s.x);
    INFO("row " << i);
    CHECK(slack > -tolerance * size);
    const bool active = std::find(s.active.begin(), s.active.end(), i) != s.active.end();
    CHECK(active == (s.multipliers(i) > 0));
    if (active) CHECK(std::abs(slack) < tolerance * size);
  }
}

TEST_CASE("random problems meet the conditions of Karush, Kuhn and Tucker", "[estimate]") {
  Normal normal(6200);
  std::size_t n_active = 0, most = 0;
  for (int run = 0; run < 500; ++run) {
    const Eigen::Index p = 1 + run % 9;
    Eigen::MatrixXd a = random_matrix(p + 4, p, normal);
    // Columns as of l, l^2, ...: each 30 times smaller than the one before.
    for (Eigen::Index k = 0; k < p; ++k) a.col(k) *= std::pow(30.0, -static_cast<double>(k));
    const Eigen::VectorXd b = random_matrix(p + 4, 1, normal);
    Eigen::MatrixXd g = random_matrix(1 + run % 25, p, normal) * a.colwise().norm().asDiagonal();
    if (g.rows() > 3) g.row(2) = 3 * g.row(0);  // the same condition twice
    const ConstrainedSolution s = constrained_least_squares(a, b, g);
    INFO("run " << run);
    check_kkt(a, b, g, s, 1e4);
    n_active += s.active.size();
    most = std::max(most, s.active.size());
  }
  std::printf("  active constraints: %zu in 500 problems, at most %zu\n", n_active, most);
  CHECK(n_active > 500);  // else nothing was tested
  CHECK(most >= 5);
}

TEST_CASE("what the data do not determine stays out of the constrained solution", "[estimate]") {
  Normal normal(6201);
  Eigen::MatrixXd a = random_matrix(20, 3, normal);
  a.col(2) = a.col(1);
  const Eigen::VectorXd b = a * Eigen::Vector3d(-2, 1, 1);
  const ConstrainedSolution s =
      constrained_least_squares(a, b, Eigen::MatrixXd::Identity(3, 3).topRows(1));
  CHECK(s.active == std::vector<Eigen::Index>{0});
  CHECK(std::abs(s.x(0)) < 1e-14);
  CHECK_THAT(s.x(1), Catch::WithinRel(s.x(2), 1e-12));
}

/// Rows of white noise about w x.
RowStatistics noisy_rows(const Eigen::MatrixXd& w, const Eigen::VectorXd& x, Normal& normal) {
  Eigen::MatrixXd rows(w.rows(), w.cols() + 1);
  rows << w, w * x;
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    rows(i, w.cols()) += 0.1 * normal();
    numbers.push_back(i);
  }
  RowStatistics statistics(rows.cols(), rows.rows());
  statistics.add(rows, numbers);
  return statistics;
}

LinearProblem problem_of(Eigen::Index p, const Eigen::MatrixXd& constraints) {
  LinearProblem problem;
  for (Eigen::Index k = 0; k < p; ++k) {
    problem.regressors.push_back(k);
    problem.names.push_back(std::string(1, static_cast<char>('a' + k)));
  }
  problem.response = Eigen::VectorXd::Unit(p + 1, p);
  problem.constraints = constraints;
  return problem;
}

TEST_CASE("constraints that hold already change no bit", "[estimate]") {
  Normal normal(6202);
  const Eigen::MatrixXd w = random_matrix(300, 3, normal);
  const RowStatistics rows = noisy_rows(w, Eigen::Vector3d(1, 2, -3), normal);
  const LinearSolution plain = solve(rows, problem_of(3, {}));
  const LinearSolution held = solve(rows, problem_of(3, Eigen::RowVector3d(1, 1, 0.5)));
  CHECK(plain.x == held.x);
  CHECK(plain.covariance == held.covariance);
  CHECK(held.active_constraints.empty());
}

TEST_CASE("a constraint on one parameter is a bound", "[estimate]") {
  Normal normal(6203);
  const Eigen::MatrixXd w = random_matrix(300, 3, normal);
  const RowStatistics rows = noisy_rows(w, Eigen::Vector3d(-1, 2, -3), normal);
  LinearProblem bounded = problem_of(3, {});
  bounded.lower = {0, -kUnbounded, -kUnbounded};
  const LinearSolution bound = solve(rows, bounded);
  const LinearSolution constraint = solve(rows, problem_of(3, Eigen::RowVector3d(5, 0, 0)));
  CHECK(constraint.x == bound.x);
  CHECK(constraint.at_bound == std::vector<bool>{true, false, false});
  CHECK(constraint.active_constraints == std::vector<Eigen::Index>{0});
  CHECK(constraint.n_params == 2);
  // Beside a bound the others are as uncertain as without it, under constraints conditional on
  // them.
  CHECK(constraint.covariance_white == bound.covariance_white);
  CHECK(constraint.covariance(1, 1) <= bound.covariance(1, 1));
}

// a + b / 2 = 0 makes it a fit of b to the column w_b - w_a / 2, and of c.
TEST_CASE("an active constraint between parameters ties them", "[estimate]") {
  Normal normal(6204);
  const Eigen::MatrixXd w = random_matrix(300, 3, normal);
  const RowStatistics rows = noisy_rows(w, Eigen::Vector3d(-1, 1, -3), normal);
  const LinearSolution s = solve(rows, problem_of(3, Eigen::RowVector3d(2, 1, 0)));
  const auto& r = rows.r();
  Eigen::MatrixXd tied(r.rows(), 2);
  tied << r.col(1) - 0.5 * r.col(0), r.col(2);
  const Eigen::Matrix2d inverse = (tied.transpose() * tied).inverse();
  const Eigen::Vector2d x = inverse * tied.transpose() * r.col(3);
  CHECK_THAT(s.x(1), Catch::WithinRel(x(0), 1e-11));
  CHECK_THAT(s.x(2), Catch::WithinRel(x(1), 1e-11));
  CHECK(std::abs(s.x(0) + s.x(1) / 2) < 1e-14);
  CHECK(s.at_bound == std::vector<bool>{false, false, false});
  CHECK(s.n_tied == 1);
  CHECK(s.n_params == 2);
  const double variance = (r.col(3) - tied * x).squaredNorm() / 298;
  CHECK_THAT(s.covariance_white(1, 1), Catch::WithinRel(variance * inverse(0, 0), 1e-9));
  CHECK_THAT(s.covariance_white(0, 1), Catch::WithinRel(-variance * inverse(0, 0) / 2, 1e-9));
  CHECK((s.unbounded_x - Eigen::Vector3d(-1, 1, -3)).norm() < 0.05);
}

TEST_CASE("constraints that leave no way out put every parameter on its bound", "[estimate]") {
  Normal normal(6205);
  const Eigen::MatrixXd w = random_matrix(300, 2, normal);
  const RowStatistics rows = noisy_rows(w, Eigen::Vector2d(-3, -1), normal);
  Eigen::Matrix2d g;
  g << 1, 0, 1, 1;
  const LinearSolution s = solve(rows, problem_of(2, g));
  CHECK(s.x == Eigen::Vector2d::Zero());
  CHECK(s.at_bound == std::vector<bool>{true, true});
  CHECK(s.n_params == 0);
}

}  // namespace
