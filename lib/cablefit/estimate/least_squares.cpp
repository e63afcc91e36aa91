#include "cablefit/estimate/least_squares.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/estimate/long_run.hpp"

namespace cablefit {
namespace {

// Columns whose scaled singular value is below this cannot be told apart in double precision data
// that carries at best nine digits ("%.9g").
constexpr double kRankTolerance = 1e-9;
constexpr double kNullComponent = 0.05;  // share in a null direction that counts as taking part
constexpr double kCorrelationWarning = 0.95;  // estimation-rules: warn above

struct ScaledSolve {
  Eigen::VectorXd x;
  Eigen::MatrixXd inverse;          // (W'W)^-1 over the free columns, 0 elsewhere
  Eigen::MatrixXd null_directions;  // p x (p - rank), columns of unit norm, in scaled parameters
  double condition_scaled = 0;
  double condition = 0;
};

ScaledSolve solve_scaled(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  const Eigen::Index p = a.cols();
  ScaledSolve s;
  if (p == 0) {  // every parameter stands on its bound
    s.inverse.resize(0, 0);
    return s;
  }
  Eigen::VectorXd norm = a.colwise().norm();
  for (Eigen::Index k = 0; k < p; ++k)
    if (!(norm(k) > 0)) norm(k) = 1;
  const Eigen::MatrixXd scaled = a * norm.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& sv = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < sv.size() && sv(rank) > kRankTolerance * sv(0)) ++rank;
  s.condition_scaled =
      sv(sv.size() - 1) > 0 ? sv(0) / sv(sv.size() - 1) : std::numeric_limits<double>::infinity();
  const Eigen::VectorXd plain = Eigen::JacobiSVD<Eigen::MatrixXd>(a).singularValues();
  s.condition =
      plain(p - 1) > 0 ? plain(0) / plain(p - 1) : std::numeric_limits<double>::infinity();
  s.null_directions = svd.matrixV().rightCols(p - rank);
  if (rank == p) {
    // Full rank: backward stable QR; the SVD above only answers how well determined it is.
    s.x = scaled.householderQr().solve(b).cwiseQuotient(norm);
  } else {
    const auto v = svd.matrixV().leftCols(rank);
    const Eigen::VectorXd c = svd.matrixU().leftCols(rank).transpose() * b;
    s.x = (v * c.cwiseQuotient(sv.head(rank))).cwiseQuotient(norm);
  }
  const Eigen::MatrixXd half = norm.cwiseInverse().asDiagonal() * svd.matrixV().leftCols(rank) *
                               sv.head(rank).cwiseInverse().asDiagonal();
  s.inverse = half * half.transpose();
  return s;
}

std::string null_text(const Eigen::VectorXd& direction, Eigen::Index self,
                      const std::vector<std::string>& names) {
  std::string others;
  for (Eigen::Index k = 0; k < direction.size(); ++k) {
    if (k == self || std::abs(direction(k)) < kNullComponent) continue;
    others += (others.empty() ? "" : ", ") + names[static_cast<std::size_t>(k)];
  }
  if (others.empty()) return "its column is zero: the log never excites it";
  return fmt::format("cannot be told apart from {} in these logs", others);
}

struct FreeFit {
  std::vector<Eigen::Index> free;  // positions within problem.regressors
  ScaledSolve solve;
};

FreeFit fit_free(const RowStatistics& rows, const LinearProblem& problem,
                 const std::vector<bool>& fixed) {
  FreeFit fit;
  for (std::size_t k = 0; k < problem.regressors.size(); ++k)
    if (!fixed[k]) fit.free.push_back(static_cast<Eigen::Index>(k));
  Eigen::MatrixXd a(rows.n_columns(), static_cast<Eigen::Index>(fit.free.size()));
  for (std::size_t k = 0; k < fit.free.size(); ++k)
    a.col(static_cast<Eigen::Index>(k)) =
        rows.r().col(problem.regressors[static_cast<std::size_t>(fit.free[k])]);
  fit.solve = solve_scaled(a, rows.r() * problem.response);
  return fit;
}

void name_null_directions(const FreeFit& fit, const LinearProblem& problem, LinearSolution& out) {
  std::vector<std::string> names;
  for (const Eigen::Index k : fit.free) names.push_back(problem.names[static_cast<std::size_t>(k)]);
  for (Eigen::Index d = 0; d < fit.solve.null_directions.cols(); ++d) {
    const Eigen::VectorXd direction = fit.solve.null_directions.col(d);
    for (Eigen::Index k = 0; k < direction.size(); ++k)
      if (std::abs(direction(k)) >= kNullComponent)
        out.not_identifiable[static_cast<std::size_t>(fit.free[static_cast<std::size_t>(k)])] =
            null_text(direction, k, names);
  }
}

// Physical bounds by an active set: fix the worst offender on its bound and fit again. All bounds
// are 0 here in practice (inertia, friction), and columns are few.
FreeFit fit_bounded(const RowStatistics& rows, const LinearProblem& problem,
                    std::vector<bool>& at_bound, Eigen::VectorXd& x) {
  for (;;) {
    FreeFit fit = fit_free(rows, problem, at_bound);
    x.setZero();
    for (std::size_t k = 0; k < fit.free.size(); ++k)
      x(fit.free[k]) = fit.solve.x(static_cast<Eigen::Index>(k));
    if (problem.lower.empty()) return fit;
    Eigen::Index worst = -1;
    double worst_ratio = 0;
    for (std::size_t k = 0; k < fit.free.size(); ++k) {
      const Eigen::Index j = fit.free[k];
      if (x(j) >= problem.lower[static_cast<std::size_t>(j)]) continue;
      const double scale =
          std::sqrt(fit.solve.inverse(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
      const double ratio = (problem.lower[static_cast<std::size_t>(j)] - x(j)) / scale;
      if (ratio > worst_ratio) {
        worst_ratio = ratio;
        worst = j;
      }
    }
    if (worst < 0) return fit;
    at_bound[static_cast<std::size_t>(worst)] = true;
  }
}

Eigen::MatrixXd expand(const FreeFit& fit, Eigen::Index p) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(p, p);
  for (std::size_t i = 0; i < fit.free.size(); ++i)
    for (std::size_t j = 0; j < fit.free.size(); ++j)
      full(fit.free[i], fit.free[j]) =
          fit.solve.inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return full;
}

// Sandwich (W'W)^-1 S (W'W)^-1 with S the long-run covariance of the cells' scores W' rho.
void honest_covariance(const RowStatistics& rows, const LinearProblem& problem,
                       LinearSolution& out) {
  const Eigen::Index p = out.x.size();
  const auto n_cells = static_cast<Eigen::Index>(rows.cells().size());
  if (n_cells < 8) {
    out.covariance = out.covariance_white;
    out.degrees_of_freedom =
        static_cast<double>(std::max<Eigen::Index>(1, out.n_rows - out.n_params));
    out.effective_rows = static_cast<double>(out.n_rows);
    return;
  }
  Eigen::MatrixXd scores(n_cells, p);
  for (Eigen::Index c = 0; c < n_cells; ++c) {
    const Eigen::VectorXd all =
        rows.cells()[static_cast<std::size_t>(c)].gram * out.residual_combination;
    for (Eigen::Index k = 0; k < p; ++k)
      scores(c, k) = all(problem.regressors[static_cast<std::size_t>(k)]);
  }
  // Rotate into the parameters before choosing a bandwidth: what counts is the correlation of each
  // estimate's own influence, not of the raw columns.
  const Eigen::MatrixXd influence = scores * out.solve_operator;
  const LongRunCovariance hac = long_run_covariance(influence);
  const double n = static_cast<double>(out.n_rows);
  const double small_sample = n / std::max(1.0, n - out.n_params);
  out.covariance = small_sample * hac.covariance;
  // No credit for anti-correlated residuals: encoder quantisation looks like that, and what the
  // filter leaves of a bias does not shrink with it.
  for (Eigen::Index k = 0; k < p; ++k) {
    const double white = out.covariance_white(k, k);
    if (out.covariance(k, k) >= white) continue;
    if (!(out.covariance(k, k) > 0)) {  // a kernel cut off is not quite positive
      out.covariance.row(k).setZero();
      out.covariance.col(k).setZero();
      out.covariance(k, k) = white;
      continue;
    }
    const double grow = std::sqrt(white / out.covariance(k, k));
    out.covariance.row(k) *= grow;
    out.covariance.col(k) *= grow;
  }
  out.degrees_of_freedom = hac.degrees_of_freedom;
  double inflation = 0;
  int counted = 0;
  for (Eigen::Index k = 0; k < p; ++k) {
    if (!(out.covariance_white(k, k) > 0)) continue;
    inflation += out.covariance(k, k) / out.covariance_white(k, k);
    ++counted;
  }
  out.effective_rows = counted > 0 && inflation > 0 ? n * counted / inflation : n;
}

void note_correlations(const LinearProblem& problem, const Eigen::MatrixXd& inverse,
                       LinearSolution& out) {
  const Eigen::Index p = out.x.size();
  out.correlation = Eigen::MatrixXd::Identity(p, p);
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double scale = std::sqrt(inverse(i, i) * inverse(j, j));
      const double c = scale > 0 ? inverse(i, j) / scale : 0;
      out.correlation(i, j) = out.correlation(j, i) = c;
      if (std::abs(c) > kCorrelationWarning)
        out.warnings.push_back(fmt::format("{} and {} can hardly be told apart: correlation {:.3f}",
                                           problem.names[static_cast<std::size_t>(j)],
                                           problem.names[static_cast<std::size_t>(i)], c));
    }
}

// With one parameter on its bound the others look better determined than they are: what they trade
// with it is still unknown. Their variance is at least that of the fit without bounds.
void widen_beside_bounds(LinearSolution& out) {
  if (std::none_of(out.at_bound.begin(), out.at_bound.end(), [](bool b) { return b; })) return;
  for (Eigen::Index k = 0; k < out.x.size(); ++k) {
    const double variance = out.unbounded_sd(k) * out.unbounded_sd(k);
    if (!(out.covariance(k, k) > 0) || variance <= out.covariance(k, k)) continue;
    const double grow = std::sqrt(variance / out.covariance(k, k));
    out.covariance.row(k) *= grow;
    out.covariance.col(k) *= grow;
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

  std::vector<bool> held(problem.regressors.size(), false);
  for (std::size_t k = 0; k < problem.held.size(); ++k) held[k] = !problem.held[k].empty();
  const FreeFit unbounded = fit_free(rows, problem, held);
  name_null_directions(unbounded, problem, out);
  out.at_bound = held;
  const FreeFit fit = fit_bounded(rows, problem, out.at_bound, out.x);
  for (std::size_t k = 0; k < problem.held.size(); ++k)
    if (held[k]) {
      out.at_bound[k] = false;
      out.not_identifiable[k] = problem.held[k];
    }
  out.condition_scaled = unbounded.solve.condition_scaled;
  out.condition = unbounded.solve.condition;
  out.solve_operator = expand(fit, p);
  out.residual_combination = problem.response;
  for (Eigen::Index k = 0; k < p; ++k) {
    out.residual_combination(problem.regressors[static_cast<std::size_t>(k)]) -= out.x(k);
    if (out.not_identifiable[static_cast<std::size_t>(k)].empty() &&
        !out.at_bound[static_cast<std::size_t>(k)])
      ++out.n_params;
  }
  out.rss = (rows.r() * out.residual_combination).squaredNorm();
  const double dof = static_cast<double>(std::max<Eigen::Index>(1, out.n_rows - out.n_params));
  out.covariance_white = out.rss / dof * out.solve_operator;
  honest_covariance(rows, problem, out);
  out.unbounded_x = Eigen::VectorXd::Zero(p);
  for (std::size_t k = 0; k < unbounded.free.size(); ++k)
    out.unbounded_x(unbounded.free[k]) = unbounded.solve.x(static_cast<Eigen::Index>(k));
  // Same noise level and the same ratio of honest to white sd as the bounded fit.
  const double honesty = std::sqrt(static_cast<double>(out.n_rows) / out.effective_rows);
  out.unbounded_sd = honesty * (out.rss / dof * expand(unbounded, p).diagonal()).cwiseSqrt();
  widen_beside_bounds(out);
  note_correlations(problem, expand(unbounded, p), out);
  return out;
}

double rms_on_cells(const std::vector<const GramCell*>& cells, const Eigen::VectorXd& combination) {
  double sum = 0;
  Eigen::Index n = 0;
  for (const GramCell* cell : cells) {
    sum += combination.dot(cell->gram * combination);
    n += cell->n_rows;
  }
  return n > 0 ? std::sqrt(std::max(0.0, sum) / static_cast<double>(n)) : 0;
}

}  // namespace cablefit
