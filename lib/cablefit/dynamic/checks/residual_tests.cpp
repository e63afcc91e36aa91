#include "cablefit/dynamic/checks/residual_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/divided_up.hpp"
#include "cablefit/estimate/spread/window_means.hpp"
#include "cablefit/estimate/tests/binned_test.hpp"
#include "cablefit/estimate/tests/portmanteau.hpp"

namespace cablefit {
namespace {

constexpr double kLevel = 0.01;     // below it a p value says that something is there
constexpr double kMaterial = 0.01;  // of the rms torque
// Of the rms torque: "none seen" says that as much would have shown.
constexpr double kShownShare = 0.1;
constexpr double kManyRows = 0.5;  // share of independent rows above which a memory is small
constexpr double kAllRows = 0.9;
constexpr double kFewIndependent = 50;  // independent: fewer look white whatever they are
constexpr double kLittle = 0.5;         // of the torque: a larger residual is reported first
constexpr double kFollows = 0.1;        // of the residual's squares: what it depends on
constexpr std::size_t kBins = 8;
constexpr std::size_t kEdgeValues = 20000;

std::string p_text(double p) { return p < 1e-6 ? "p < 1e-6" : fmt::format("p = {:.2g}", p); }

ResidualTest whiteness(const TestedRows& tested, const WhitenessTest& test) {
  ResidualTest out;
  out.name = "whiteness";
  if (!test.is_possible()) {
    out.finding = Finding::untestable;
    out.verdict = "too few consecutive rows";
    return out;
  }
  out.statistic = fmt::format("Ljung-Box, {} lags", test.lags);
  out.value = test.statistic;
  out.p_value = test.p_value;
  const auto n_rows = static_cast<double>(test.n_rows);
  if (test.p_value >= kLevel) {
    out.verdict = fmt::format("white below the cut-off ({})", p_text(test.p_value));
    if (test.effective_rows < kFewIndependent) {
      out.finding = Finding::untestable;
      out.verdict = fmt::format("too few independent rows ({:.0f})", test.effective_rows);
    }
    return out;
  }
  out.finding = test.effective_rows < kManyRows * n_rows ? Finding::material : Finding::immaterial;
  if (test.effective_rows > kAllRows * n_rows) {
    out.verdict = fmt::format("not white, but nearly all rows count as independent ({})",
                              p_text(test.p_value));
    return out;
  }
  out.verdict =
      fmt::format("correlated over {:.2g} ms, {:.0f} of {} rows count as independent ({})",
                  1e3 * tested.row_seconds * n_rows / test.effective_rows, test.effective_rows,
                  test.n_rows, p_text(test.p_value));
  return out;
}

ResidualTest dependence(const TestedRows& tested, const JudgedVariable& variable,
                        const BinnedTestResult& test) {
  ResidualTest out;
  out.name = variable.name;
  if (!test.is_possible) {
    out.finding = Finding::untestable;
    out.verdict =
        test.dof_1 > 0 ? "too few independent rows" : "the fit explains it; no residual to test";
    return out;
  }
  out.statistic = fmt::format("F({:.0f}, {:.0f})", test.dof_1, test.dof_2);
  out.value = test.f;
  out.p_value = test.p_value;
  out.structure = test.structure;
  if (test.p_value >= kLevel) {
    out.verdict = fmt::format("none seen ({})", p_text(test.p_value));
    if (test.detectable > kShownShare * tested.torque_rms) {
      out.finding = Finding::untestable;
      out.verdict =
          fmt::format("too few independent rows: an effect below {:.2g} {} rms would not be seen",
                      test.detectable, tested.torque_unit);
    }
    return out;
  }
  const double share = tested.torque_rms > 0 ? test.structure / tested.torque_rms : 0;
  out.finding = share >= kMaterial ? Finding::material : Finding::immaterial;
  out.verdict = fmt::format(
      "{}: {:.2g} {} rms, {:.2g} % of the torque, most at {:.2g}{}: {:+.2g} "
      "{} ({})",
      out.finding == Finding::material ? "depends on it" : "seen, but small", test.structure,
      tested.torque_unit, 100 * share, test.largest_at,
      variable.unit.empty() ? "" : " " + variable.unit, test.largest, tested.torque_unit,
      p_text(test.p_value));
  return out;
}

struct VariableTest {
  const JudgedVariable* variable;
  BinnedTest test;
};

std::vector<VariableTest> new_tests(const JudgedRows& rows, Eigen::Index n_regressors) {
  const Eigen::Index places = stretch_places(rows.last_number);
  std::vector<VariableTest> tests;
  for (const JudgedVariable& variable : rows.variables) {
    if (!variable.tested) continue;
    std::vector<double> edges =
        bin_edges(sampled_column(rows, variable.column, kEdgeValues), kBins);
    if (!edges.empty())
      tests.push_back({&variable, BinnedTest(std::move(edges), n_regressors, places)});
  }
  return tests;
}

}  // namespace

std::vector<double> sampled_column(const JudgedRows& rows, Eigen::Index column, std::size_t most) {
  const Eigen::Index step =
      std::max<Eigen::Index>(1, divided_up(rows.n_rows, static_cast<Eigen::Index>(most)));
  return rows.rows->every(step, column);
}

namespace {

/// That the model explains little, and which variable the residual follows most.
std::string headline(const TestedRows& tested, double relative,
                     const std::vector<VariableTest>& tests,
                     const std::vector<BinnedTestResult>& results) {
  if (!(relative > kLittle)) return "";
  std::string text = fmt::format(
      "the model explains little: the residual is {:.2g} {} rms, {:.0f} % of the torque",
      relative * tested.torque_rms, tested.torque_unit, 100 * relative);
  std::size_t most = 0;
  for (std::size_t k = 1; k < results.size(); ++k)
    if (results[k].explained > results[most].explained) most = k;
  if (!results.empty() && results[most].explained > kFollows)
    text += fmt::format("; {:.0f} % of its squares follow {}", 100 * results[most].explained,
                        tests[most].variable->name);
  return text;
}

}  // namespace

std::vector<ResidualTest> residual_tests(const TestedRows& tested, const LinearSolution& solution,
                                         JudgedEquation& equation) {
  const Eigen::Index p = solution.x.size();
  std::vector<VariableTest> tests = new_tests(tested.rows, p);
  Portmanteau memory;
  WindowMeans means;
  double squares = 0, n_rows = 0;
  tested.rows.rows->for_each(
      [&](const Eigen::MatrixXd& rows, std::span<const Eigen::Index> numbers) {
        const Eigen::VectorXd residual =
            rows.leftCols(tested.rows.n_own) * solution.residual_combination;
        squares += residual.squaredNorm();
        n_rows += static_cast<double>(residual.size());
        memory.add(numbers, residual);
        means.add(numbers, residual);
        for (VariableTest& one : tests)
          one.test.add(numbers, rows.col(one.variable->column), residual, rows.leftCols(p));
      });
  std::vector<ResidualTest> out = {whiteness(tested, memory.result())};
  std::vector<BinnedTestResult> results;
  for (const VariableTest& one : tests) {
    results.push_back(tested.fitted ? one.test.of_fitted_rows()
                                    : one.test.of_unseen_rows(solution.covariance));
    out.push_back(dependence(tested, *one.variable, results.back()));
  }
  if (n_rows > 0 && tested.torque_rms > 0)
    equation.relative = std::sqrt(squares / n_rows) / tested.torque_rms;
  equation.means = means.result(tested.row_seconds);
  equation.headline = headline(tested, equation.relative, tests, results);
  return out;
}

}  // namespace cablefit
