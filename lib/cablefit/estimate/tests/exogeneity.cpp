#include "cablefit/estimate/tests/exogeneity.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/instruments.hpp"
#include "cablefit/estimate/spread/tail_probability.hpp"

namespace cablefit {
namespace {

constexpr double kLeastCorrelation = 1e-10;  // of correlations between what is tested

/// y on [W Z]; instruments that are regressors themselves are there already.
LinearProblem augmented(const LinearProblem& problem) {
  LinearProblem more = problem;
  more.instruments.clear();
  more.lower.clear();
  more.constraints.resize(0, 0);
  for (const Eigen::Index z : problem.instruments) {
    if (std::find(more.regressors.begin(), more.regressors.end(), z) != more.regressors.end())
      continue;
    more.regressors.push_back(z);
    more.names.emplace_back("instrument");
    if (!more.held.empty()) more.held.emplace_back();
  }
  return more;
}

/// x' C^+ x and the rank of C, by its correlations.
struct Wald {
  double sum = 0, rank = 0;
};

Wald wald(const Eigen::VectorXd& x, const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd z = x.cwiseQuotient(sd);
  const Eigen::MatrixXd correlation =
      sd.cwiseInverse().asDiagonal() * covariance * sd.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  Wald result;
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const double value = eigen.eigenvalues()(k);
    if (!(value > kLeastCorrelation)) continue;
    const double along = eigen.eigenvectors().col(k).dot(z);
    result.sum += along * along / value;
    result.rank += 1;
  }
  return result;
}

}  // namespace

std::string ExogeneityTest::p_text() const {
  return p_value < 0.001 ? "p < 0.001" : fmt::format("p = {:.2g}", p_value);
}

ExogeneityTest test_exogeneity(const RowStatistics& rows, const LinearProblem& problem) {
  const LinearProblem more = augmented(problem);
  const LinearSolution s = solve(rows, more);
  std::vector<Eigen::Index> tested;
  for (std::size_t k = problem.regressors.size(); k < more.regressors.size(); ++k)
    if (s.not_identifiable[k].empty() &&
        s.covariance(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) > 0)
      tested.push_back(static_cast<Eigen::Index>(k));
  ExogeneityTest test;
  if (tested.empty()) return test;
  const Wald distance = wald(s.x(tested), s.covariance(tested, tested));
  if (!(distance.rank > 0)) return test;
  test.possible = true;
  test.dof_numerator = distance.rank;
  test.dof_denominator = s.degrees_of_freedom;
  test.statistic = distance.sum / distance.rank;
  test.p_value = f_tail(test.statistic, test.dof_numerator, test.dof_denominator);
  return test;
}

EstimateDifference largest_difference(const LinearSolution& plain, const LinearSolution& with) {
  EstimateDifference most;
  for (Eigen::Index k = 0; k < with.x.size(); ++k) {
    const double sd = std::sqrt(plain.covariance(k, k));
    if (!(sd > 0) || !(with.covariance(k, k) > 0)) continue;
    const double difference = with.x(k) - plain.x(k);
    if (most.parameter >= 0 && std::abs(difference / sd) <= std::abs(most.in_sd)) continue;
    most = {k, difference / sd, difference / std::abs(with.x(k))};
  }
  return most;
}

Difference judge_difference(const EstimateDifference& difference, const Materiality& limits) {
  if (difference.parameter < 0 || std::abs(difference.in_sd) < limits.sd) return Difference::none;
  return std::abs(difference.relative) < limits.relative ? Difference::small : Difference::material;
}

bool has_weak_instruments(const LinearSolution& s) {
  for (Eigen::Index k = 0; k < s.x.size(); ++k)
    if (s.not_identifiable[static_cast<std::size_t>(k)].empty() &&
        first_stage_f(s.first_stage(k), s.effective_rows) < kStrongFirstStage)
      return true;
  return false;
}

}  // namespace cablefit
