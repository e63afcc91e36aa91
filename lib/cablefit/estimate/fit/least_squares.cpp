#include "cablefit/estimate/fit/least_squares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/active_set.hpp"
#include "cablefit/estimate/fit/instruments.hpp"
#include "cablefit/estimate/fit/solution_covariance.hpp"
#include "cablefit/estimate/solve/identifiability.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"

namespace cablefit {
namespace {

struct FreeFit {
  std::vector<Eigen::Index> free;
  ScaledSolve solve;  ///< of x(free), also where a basis ties them
};

Eigen::MatrixXd columns_of(const RowStatistics& rows, const LinearProblem& problem,
                           const std::vector<Eigen::Index>& which) {
  Eigen::MatrixXd a(rows.n_columns(), static_cast<Eigen::Index>(which.size()));
  for (std::size_t k = 0; k < which.size(); ++k)
    a.col(static_cast<Eigen::Index>(k)) =
        rows.r().col(problem.regressors[static_cast<std::size_t>(which[k])]);
  return a;
}

/// What is minimised is |a x - b|, a and b seen through the instruments when there are any.
FreeFit fit_free(const RowStatistics& rows, const LinearProblem& problem, const Instruments& seen,
                 const Freedom& freedom) {
  FreeFit fit{freedom.free, {}};
  const Eigen::MatrixXd a = seen.project(columns_of(rows, problem, freedom.free));
  const Eigen::VectorXd b = seen.project(rows.r() * problem.response);
  if (!freedom.basis) {
    fit.solve = solve_scaled(a, b, problem.rank_tolerance);
    return fit;
  }
  const Eigen::MatrixXd& basis = *freedom.basis;
  fit.solve = solve_scaled(a * basis, b, problem.rank_tolerance);
  fit.solve.x = basis * fit.solve.x;
  fit.solve.inverse = basis * fit.solve.inverse * basis.transpose();
  return fit;
}

/// The columns of the problem that `which` lists, for words about them.
struct Words {
  std::vector<NamedColumn> names;
  Eigen::VectorXd rms;
};

Words words_for(const RowStatistics& rows, const LinearProblem& problem,
                const std::vector<Eigen::Index>& which) {
  Words words{{}, Eigen::VectorXd(static_cast<Eigen::Index>(which.size()))};
  const double n = static_cast<double>(std::max<Eigen::Index>(1, rows.n_rows()));
  for (const Eigen::Index k : which) {
    const auto at = static_cast<std::size_t>(k);
    words.rms(static_cast<Eigen::Index>(words.names.size())) =
        rows.r().col(problem.regressors[at]).norm() / std::sqrt(n);
    words.names.push_back(
        {problem.names[at], at < problem.motion.size() ? problem.motion[at] : MotionColumn{}});
  }
  return words;
}

void name_null_directions(const FreeFit& fit, const Words& words, LinearSolution& out) {
  const std::vector<std::string> texts =
      not_determined(fit.solve.null_directions, words.rms, words.names);
  for (std::size_t k = 0; k < texts.size(); ++k)
    if (!texts[k].empty()) out.not_identifiable[static_cast<std::size_t>(fit.free[k])] = texts[k];
}

/// Of two parameters that only show together the sum that does, with its value: "; offset + f_s =
/// 3.05 +- 0.02 is determined".
void add_determined_sums(const FreeFit& fit, const Words& words, LinearSolution& out) {
  const Eigen::MatrixXd directions = sparse_directions(fit.solve.null_directions);
  for (Eigen::Index d = 0; d < directions.cols(); ++d) {
    std::vector<Eigen::Index> members;
    for (Eigen::Index k = 0; k < directions.rows(); ++k)
      if (std::abs(directions(k, d)) >= kNullComponent) members.push_back(k);
    if (members.size() != 2 || !(words.rms(members[0]) > 0) || !(words.rms(members[1]) > 0))
      continue;
    const Eigen::Index a = members[0], b = members[1];
    const double share = -directions(b, d) * words.rms(a) / (directions(a, d) * words.rms(b));
    const Eigen::Index at_a = fit.free[static_cast<std::size_t>(a)],
                       at_b = fit.free[static_cast<std::size_t>(b)];
    const Eigen::MatrixXd& c = out.covariance;
    const double variance =
        c(at_b, at_b) + 2 * share * c(at_a, at_b) + share * share * c(at_a, at_a);
    const std::string text =
        fmt::format("; {} {} {}{} = {:.4g} +- {:.2g} is determined",
                    words.names[static_cast<std::size_t>(b)].name, share < 0 ? "-" : "+",
                    std::abs(std::abs(share) - 1) < 1e-3 ? std::string()
                                                         : fmt::format("{:.3g} ", std::abs(share)),
                    words.names[static_cast<std::size_t>(a)].name,
                    fit.solve.x(b) + share * fit.solve.x(a), std::sqrt(std::max(0.0, variance)));
    for (const Eigen::Index k : {at_a, at_b})
      if (std::string& said = out.not_identifiable[static_cast<std::size_t>(k)]; !said.empty())
        said += text;
  }
}

/// The fit under all inequalities; `unbounded` itself when it satisfies them.
FreeFit fit_constrained(const RowStatistics& rows, const LinearProblem& problem,
                        const Instruments& seen, const FreeFit& unbounded, LinearSolution& out) {
  const ActiveSet active = find_active_set(seen.project(columns_of(rows, problem, unbounded.free)),
                                           seen.project(rows.r() * problem.response),
                                           unbounded.solve.x, problem, unbounded.free);
  if (active.empty) return unbounded;
  out.active_constraints = active.constraints;
  for (const Eigen::Index k : unbounded.free) out.at_bound[static_cast<std::size_t>(k)] = true;
  for (const Eigen::Index k : active.freedom.free)
    out.at_bound[static_cast<std::size_t>(k)] = false;
  out.n_tied = active.freedom.n_tied();
  return fit_free(rows, problem, seen, active.freedom);
}

Eigen::MatrixXd expand(const FreeFit& fit, Eigen::Index p) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(p, p);
  for (std::size_t i = 0; i < fit.free.size(); ++i)
    for (std::size_t j = 0; j < fit.free.size(); ++j)
      full(fit.free[i], fit.free[j]) =
          fit.solve.inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return full;
}

void note_correlations(const FreeFit& unbounded, const Words& words, LinearSolution& out) {
  out.correlation = Eigen::MatrixXd::Identity(out.x.size(), out.x.size());
  const Eigen::MatrixXd& inverse = unbounded.solve.inverse;
  for (Eigen::Index i = 0; i < inverse.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double scale = std::sqrt(inverse(i, i) * inverse(j, j));
      const double c = scale > 0 ? inverse(i, j) / scale : 0;
      const auto a = static_cast<std::size_t>(j), b = static_cast<std::size_t>(i);
      out.correlation(unbounded.free[a], unbounded.free[b]) = c;
      out.correlation(unbounded.free[b], unbounded.free[a]) = c;
      if (std::abs(c) > kCorrelationTold)
        out.warnings.push_back(
            hardly_apart(words.names[a], words.rms(j), words.names[b], words.rms(i), c));
    }
}

/// How well the instruments stand for the regressors, and which they hardly do.
void note_first_stage(const RowStatistics& rows, const LinearProblem& problem,
                      const FreeFit& unbounded, LinearSolution& out) {
  out.first_stage = Eigen::VectorXd::Ones(out.x.size());
  if (problem.instruments.empty()) return;
  const Eigen::MatrixXd own = columns_of(rows, problem, unbounded.free);
  const Eigen::VectorXd plain = solve_scaled(own, rows.r() * problem.response).inverse.diagonal();
  for (std::size_t i = 0; i < unbounded.free.size(); ++i) {
    const Eigen::Index k = unbounded.free[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double with = unbounded.solve.inverse(at, at);
    out.first_stage(k) = with > 0 ? std::min(1.0, plain(at) / with) : 0;
    const double f = first_stage_f(out.first_stage(k), out.effective_rows);
    if (f >= kStrongFirstStage || !out.not_identifiable[static_cast<std::size_t>(k)].empty())
      continue;
    out.warnings.push_back(
        fmt::format("weak instruments: the simulated motion does not determine {} well "
                    "(first-stage F = {:.2g}, below {:g})",
                    problem.names[static_cast<std::size_t>(k)], f, kStrongFirstStage));
  }
}

}  // namespace

double LinearSolution::rms() const {
  return n_rows > 0 ? std::sqrt(rss / static_cast<double>(n_rows)) : 0;
}

LinearSolution solve(const RowStatistics& rows, const LinearProblem& problem) {
  const auto p = static_cast<Eigen::Index>(problem.regressors.size());
  LinearSolution out;
  out.x = Eigen::VectorXd::Zero(p);
  out.not_identifiable.assign(problem.regressors.size(), "");
  out.at_bound.assign(problem.regressors.size(), false);
  out.n_rows = rows.n_rows();
  out.instruments = problem.instruments;

  Freedom all;
  for (std::size_t k = 0; k < problem.regressors.size(); ++k) {
    const bool held = k < problem.held.size() && !problem.held[k].empty();
    if (!held) all.free.push_back(static_cast<Eigen::Index>(k));
    if (held) out.not_identifiable[k] = problem.held[k];
  }
  const Instruments seen(rows, problem.instruments);
  const FreeFit unbounded = fit_free(rows, problem, seen, all);
  const Words words = words_for(rows, problem, all.free);
  name_null_directions(unbounded, words, out);
  const FreeFit fit = fit_constrained(rows, problem, seen, unbounded, out);
  for (std::size_t k = 0; k < fit.free.size(); ++k)
    out.x(fit.free[k]) = fit.solve.x(static_cast<Eigen::Index>(k));
  out.condition_scaled = unbounded.solve.condition_scaled;
  out.condition = unbounded.solve.condition;
  out.solve_operator = expand(fit, p);
  out.score_columns = seen.score_columns(rows, problem.regressors);
  out.residual_combination = problem.response;
  for (Eigen::Index k = 0; k < p; ++k) {
    out.residual_combination(problem.regressors[static_cast<std::size_t>(k)]) -= out.x(k);
    if (out.not_identifiable[static_cast<std::size_t>(k)].empty() &&
        !out.at_bound[static_cast<std::size_t>(k)])
      ++out.n_params;
  }
  out.n_params -= out.n_tied;
  out.rss = (rows.r() * out.residual_combination).squaredNorm();
  const double dof = static_cast<double>(std::max<Eigen::Index>(1, out.n_rows - out.n_params));
  out.covariance_white = out.rss / dof * out.solve_operator;
  robust_covariance(rows, out);
  add_determined_sums(unbounded, words, out);
  out.unbounded_x = Eigen::VectorXd::Zero(p);
  for (std::size_t k = 0; k < unbounded.free.size(); ++k)
    out.unbounded_x(unbounded.free[k]) = unbounded.solve.x(static_cast<Eigen::Index>(k));
  // Same noise level and the same ratio of robust to white sd as the bounded fit.
  const double widening = std::sqrt(static_cast<double>(out.n_rows) / out.effective_rows);
  out.unbounded_sd = widening * (out.rss / dof * expand(unbounded, p).diagonal()).cwiseSqrt();
  if (out.active_constraints.empty()) widen_beside_bounds(out);
  note_correlations(unbounded, words, out);
  note_first_stage(rows, problem, unbounded, out);
  return out;
}

double largest_change_in_sd(const LinearSolution& from, const LinearSolution& to) {
  double largest = 0;
  for (Eigen::Index k = 0; k < to.x.size(); ++k) {
    const double sd = std::sqrt(to.covariance(k, k));
    if (sd > 0) largest = std::max(largest, std::abs(to.x(k) - from.x(k)) / sd);
  }
  return largest;
}

}  // namespace cablefit
