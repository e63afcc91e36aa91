// Which of several coupled joints stick: against all patterns tried, and by the law itself.
#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "cablefit/simulate/coupled_friction.hpp"

namespace {

using namespace cablefit;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct FrictionProblem {
  RowMatrix a;
  Eigen::VectorXd b;
  std::vector<CoupledFriction::Law> laws;
};

/// `condition`: of the matrix, about. Every fifth joint is free, levels differ by direction.
FrictionProblem random_problem(std::mt19937& engine, Eigen::Index n, double condition) {
  std::uniform_real_distribution<double> any(-1, 1);
  const RowMatrix root = RowMatrix::NullaryExpr(n, n, [&] { return any(engine); });
  FrictionProblem p{
      root * root.transpose(), Eigen::VectorXd::NullaryExpr(n, [&] { return any(engine); }), {}};
  p.a.diagonal().array() += p.a.trace() / condition;
  for (Eigen::Index k = 0; k < n; ++k)
    p.laws.push_back({std::abs(any(engine)), std::abs(any(engine)), any(engine) < 0.6});
  return p;
}

double function_value(const FrictionProblem& p, const Eigen::VectorXd& x) {
  double sum = 0.5 * x.dot(p.a * x) - p.b.dot(x);
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const CoupledFriction::Law& law = p.laws[static_cast<std::size_t>(k)];
    if (law.is_dry) sum += law.up * std::max(x(k), 0.0) + law.down * std::max(-x(k), 0.0);
  }
  return sum;
}

/// The best of all patterns that keep their signs.
Eigen::VectorXd best_of_all(const FrictionProblem& p) {
  const Eigen::Index n = p.b.size();
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double least = INFINITY;
  for (int pattern = 0; pattern < static_cast<int>(std::pow(3, n)); ++pattern) {
    RowMatrix a = p.a;
    Eigen::VectorXd b = p.b;
    std::vector<int> direction;
    int digits = pattern;
    for (Eigen::Index k = 0; k < n; ++k, digits /= 3) {
      const CoupledFriction::Law& law = p.laws[static_cast<std::size_t>(k)];
      direction.push_back(digits % 3 - 1);
      if (!law.is_dry) continue;
      b(k) -= direction.back() > 0 ? law.up : direction.back() < 0 ? -law.down : 0;
      if (direction.back() != 0) continue;
      a.row(k).setZero();
      a.col(k).setZero();
      a(k, k) = 1;
      b(k) = 0;
    }
    const Eigen::VectorXd x = a.llt().solve(b);
    bool keeps = true;
    for (Eigen::Index k = 0; k < n; ++k)
      keeps = keeps && (!p.laws[static_cast<std::size_t>(k)].is_dry ||
                        x(k) * direction[static_cast<std::size_t>(k)] >= 0);
    if (!keeps || !(function_value(p, x) < least)) continue;
    least = function_value(p, x);
    best = x;
  }
  return best;
}

TEST_CASE("the joints that stick are those of the best pattern", "[simulate]") {
  std::mt19937 engine(8);
  int n_resting = 0, n_moving = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const Eigen::Index n = 1 + trial % 5;
    const FrictionProblem p = random_problem(engine, n, trial % 2 == 0 ? 100 : 1e4);
    const Eigen::VectorXd expected = best_of_all(p);
    Eigen::VectorXd x(n);
    CoupledFriction friction(static_cast<std::size_t>(n));
    REQUIRE(friction.solve(p.a.data(), p.b.data(), p.laws.data(), x.data()));
    // Rounding times the condition of the matrix.
    CHECK((x - expected).norm() <= 1e-11 * (1 + expected.norm()));
    for (Eigen::Index k = 0; k < n; ++k) {
      CHECK((x(k) == 0) == (expected(k) == 0));
      (x(k) == 0 ? n_resting : n_moving) += 1;
    }
  }
  CHECK(n_resting > 100);
  CHECK(n_moving > 100);
}

TEST_CASE("many coupled joints obey the law of dry friction", "[simulate]") {
  std::mt19937 engine(9);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Index n = 20;
    const FrictionProblem p = random_problem(engine, n, 1e3);
    Eigen::VectorXd x(n);
    CoupledFriction friction(20);
    REQUIRE(friction.solve(p.a.data(), p.b.data(), p.laws.data(), x.data()));
    const Eigen::VectorXd held = p.b - p.a * x;
    for (Eigen::Index k = 0; k < n; ++k) {
      const CoupledFriction::Law& law = p.laws[static_cast<std::size_t>(k)];
      const double expected = !law.is_dry ? 0 : x(k) > 0 ? law.up : -law.down;
      if (law.is_dry && x(k) == 0)
        CHECK((held(k) <= law.up && held(k) >= -law.down));
      else
        CHECK(std::abs(held(k) - expected) < 1e-12);
    }
  }
}

TEST_CASE("a mass matrix that is not positive definite is told", "[simulate]") {
  const double a[] = {1, 2, 2, 1}, b[] = {1, 1};
  const CoupledFriction::Law laws[2];
  double x[] = {7, 7};
  CoupledFriction friction(2);
  CHECK_FALSE(friction.solve(a, b, laws, x));
  CHECK(x[0] == 7);
}

}  // namespace
