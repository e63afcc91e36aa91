// Digits of the nonlinear least squares against NIST's certified values, and what it says of
// problems that have no answer.
#include "cablefit/estimate/fit/nonlinear_least_squares.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "tests/estimate/nist_nonlinear_sets.hpp"

namespace {

using namespace cablefit;
using cablefit::test::NistNonlinearSet;

double certified_digits(double found, double certified) {
  const double relative = std::abs(found - certified) / std::abs(certified);
  return relative > 0 ? std::min(11.0, -std::log10(relative)) : 11;  // certified to 11 digits
}

NonlinearProblem problem_of(const NistNonlinearSet& set, const std::vector<double>& start) {
  NonlinearProblem problem;
  problem.start =
      Eigen::Map<const Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
  for (std::size_t k = 0; k < start.size(); ++k)
    problem.names.push_back("b" + std::to_string(k + 1));
  problem.n_residuals = static_cast<Eigen::Index>(set.x.size());
  problem.rank_tolerance = 1e-14;  // exact by definition
  problem.evaluate = [&set](const Eigen::VectorXd& b, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    std::vector<double> d(static_cast<std::size_t>(b.size()));
    for (std::size_t i = 0; i < set.x.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      r(row) = set.model(b.data(), set.x[i], d.data()) - set.y[i];
      if (j) j->row(row) = Eigen::Map<const Eigen::RowVectorXd>(d.data(), b.size());
    }
    return true;
  };
  return problem;
}

// Of Lanczos1: it has residuals of 1e-13, 12 digits below y: rounding of y itself leaves them few
// digits, and its sd with them.
double least_digits_of_sd(const NistNonlinearSet& set) { return set.name == "Lanczos1" ? 1 : 6; }

TEST_CASE("NIST nonlinear regression, from both starts", "[estimate]") {
  NonlinearOptions options;
  options.max_iterations = 5000;
  options.function_tolerance = options.parameter_tolerance = 1e-16;
  for (const NistNonlinearSet& set : test::nist_nonlinear_sets()) {
    for (std::size_t s = 0; s < set.starts.size(); ++s) {
      const NonlinearSolution solution = solve(problem_of(set, set.starts[s]), options);
      const double variance = solution.rss / static_cast<double>(set.x.size() - set.value.size());
      double of_value = 11, of_sd = 11;
      for (std::size_t k = 0; k < set.value.size(); ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        of_value = std::min(of_value, certified_digits(solution.x(i), set.value[k]));
        of_sd = std::min(of_sd,
                         certified_digits(std::sqrt(variance * solution.inverse(i, i)), set.sd[k]));
      }
      std::printf(
          "  NIST %-8s (%c) start %zu, digits: estimates %4.1f, sd %4.1f, residual sd %4.1f; "
          "%d evaluations; %s\n",
          set.name.c_str(), set.difficulty, s + 1, of_value, of_sd,
          certified_digits(std::sqrt(variance), set.residual_sd), solution.n_evaluations,
          solution.message.c_str());
      INFO(set.name << " from start " << s + 1);
      CHECK(of_value >= 6);
      CHECK(of_sd >= least_digits_of_sd(set));
    }
  }
}

NonlinearProblem line(const std::vector<double>& x, const std::vector<double>& y) {
  NonlinearProblem problem;
  problem.names = {"a", "b"};
  problem.start = Eigen::Vector2d(0.5, 0.5);
  problem.n_residuals = static_cast<Eigen::Index>(x.size());
  problem.evaluate = [x, y](const Eigen::VectorXd& b, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      r(row) = b(0) + b(1) * x[i] - y[i];
      if (j) j->row(row) << 1, x[i];
    }
    return true;
  };
  return problem;
}

TEST_CASE("a parameter stops at its bound, and says so", "[estimate]") {
  NonlinearProblem problem = line({0, 1, 2, 3}, {3, 2, 1, 0});
  problem.lower = Eigen::Vector2d(-1e300, 0);
  problem.upper = Eigen::Vector2d(1e300, 1e300);
  const NonlinearSolution s = solve(problem);
  CHECK(s.converged);
  CHECK(s.x(1) == 0);
  CHECK(s.at_bound[1]);
  CHECK_FALSE(s.at_bound[0]);
  CHECK_THAT(s.x(0), Catch::WithinRel(1.5, 1e-6));  // the mean; |r|^2 to 1e-12
  CHECK(s.rank == 1);
  CHECK_THAT(s.inverse(0, 0), Catch::WithinRel(0.25, 1e-12));
  CHECK(s.inverse(1, 1) == 0);
}

TEST_CASE("what the data cannot tell apart is named", "[estimate]") {
  const NonlinearSolution s = solve(line({2, 2, 2}, {1, 2, 3}));
  CHECK(s.rank == 1);
  CHECK(s.not_identifiable[0] == "is not separable from b in these logs");
  CHECK(s.not_identifiable[1] == "is not separable from a in these logs");
}

TEST_CASE("not to converge is a result", "[estimate]") {
  const NistNonlinearSet set = test::nist_nonlinear_sets().front();
  NonlinearOptions options;
  options.max_iterations = 2;
  const NonlinearSolution s = solve(problem_of(set, set.starts.front()), options);
  CHECK_FALSE(s.converged);
  CHECK(s.message == "no convergence after 2 iterations");
}

TEST_CASE("a residual without a value at the start is a result", "[estimate]") {
  NonlinearProblem problem = line({0, 1}, {0, 1});
  problem.evaluate = [](const Eigen::VectorXd&, Eigen::VectorXd&, Eigen::MatrixXd*) {
    return false;
  };
  const NonlinearSolution s = solve(problem);
  CHECK_FALSE(s.converged);
  CHECK(s.message == "the residual has no value at the start");
}

TEST_CASE("a compressed residual has the same minimum", "[estimate]") {
  const NistNonlinearSet set = test::nist_nonlinear_sets().front();
  NonlinearProblem full = problem_of(set, set.starts[1]);
  NonlinearProblem compressed = full;
  compressed.n_residuals = 3;
  compressed.jacobian_is_cheap = true;
  compressed.evaluate = [&](const Eigen::VectorXd& b, Eigen::VectorXd& r, Eigen::MatrixXd* j) {
    Eigen::VectorXd residual(full.n_residuals);
    Eigen::MatrixXd rows(full.n_residuals, 3), jacobian(full.n_residuals, 2);
    full.evaluate(b, residual, &jacobian);
    rows << jacobian, residual;
    const Eigen::MatrixXd qr = rows.householderQr().matrixQR().topRows(3);
    const Eigen::MatrixXd triangle = qr.triangularView<Eigen::Upper>();
    r = triangle.col(2);
    if (j) *j = triangle.leftCols(2);
    return true;
  };
  const NonlinearSolution a = solve(full), b = solve(compressed);
  CHECK_THAT(b.x(0), Catch::WithinRel(a.x(0), 1e-9));
  CHECK_THAT(b.rss, Catch::WithinRel(a.rss, 1e-9));
  CHECK_THAT(b.inverse(1, 1), Catch::WithinRel(a.inverse(1, 1), 1e-6));
}

}  // namespace
