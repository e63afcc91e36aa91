#include "cablefit/estimate/fit/nonlinear_least_squares.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/solve/identifiability.hpp"

namespace cablefit {
namespace {

constexpr double kFirstRadii[] = {1e4, 10, 1};  // of trust regions, in parameters of size about 1
constexpr double kFlat = 1e-12;

/// The problem in parameters of size about 1, with what was evaluated last.
class ScaledProblem {
 public:
  explicit ScaledProblem(const NonlinearProblem& problem) : problem_(problem) {
    scale_ = problem.scale.size() > 0 ? problem.scale : problem.start.cwiseAbs();
    for (double& s : scale_)
      if (!(s > 0)) s = 1;
  }

  const Eigen::VectorXd& scale() const { return scale_; }
  Eigen::VectorXd start() const { return problem_.start.cwiseQuotient(scale_); }
  double lower(Eigen::Index k) const { return bound(problem_.lower, k, -kUnbounded); }
  double upper(Eigen::Index k) const { return bound(problem_.upper, k, kUnbounded); }
  int n_evaluations() const { return n_evaluations_; }
  Eigen::VectorXd unscaled(const Eigen::VectorXd& u) const {
    // On a bound exactly, whatever scaling there and back rounds.
    Eigen::VectorXd x = u.cwiseProduct(scale_);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (u(k) <= lower(k)) x(k) = problem_.lower(k);
      if (u(k) >= upper(k)) x(k) = problem_.upper(k);
    }
    return x;
  }

  /// Residual and, if wanted, Jacobian with respect to u, at u.
  bool evaluate(const Eigen::VectorXd& u, bool with_jacobian) {
    const bool same = u.size() == u_.size() && u == u_;
    if (same && (has_jacobian_ || !with_jacobian)) return valid_;
    has_jacobian_ = with_jacobian || problem_.jacobian_is_cheap;
    u_ = u;
    residual_.resize(problem_.n_residuals);
    jacobian_.resize(problem_.n_residuals, u.size());
    ++n_evaluations_;
    valid_ = problem_.evaluate(unscaled(u), residual_, has_jacobian_ ? &jacobian_ : nullptr) &&
             residual_.allFinite() && (!has_jacobian_ || jacobian_.allFinite());
    if (valid_ && has_jacobian_) jacobian_ = jacobian_ * scale_.asDiagonal();
    return valid_;
  }
  const Eigen::VectorXd& residual() const { return residual_; }
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }

 private:
  double bound(const Eigen::VectorXd& bounds, Eigen::Index k, double none) const {
    return bounds.size() > 0 ? bounds(k) / scale_(k) : none;
  }

  const NonlinearProblem& problem_;
  Eigen::VectorXd scale_;
  Eigen::VectorXd u_, residual_;
  Eigen::MatrixXd jacobian_;  ///< with respect to u
  bool has_jacobian_ = false, valid_ = false;
  int n_evaluations_ = 0;
};

class Cost final : public ceres::CostFunction {
 public:
  Cost(ScaledProblem* problem, Eigen::Index n_residuals, Eigen::Index n_parameters)
      : problem_(problem) {
    set_num_residuals(static_cast<int>(n_residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(n_parameters));
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Index p = parameter_block_sizes().front();
    const Eigen::Map<const Eigen::VectorXd> u(parameters[0], p);
    const bool with_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    if (!problem_->evaluate(u, with_jacobian)) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = problem_->residual();
    if (with_jacobian) {
      for (Eigen::Index i = 0; i < num_residuals(); ++i)
        for (Eigen::Index k = 0; k < p; ++k) jacobians[0][i * p + k] = problem_->jacobian()(i, k);
    }
    return true;
  }

 private:
  ScaledProblem* problem_;
};

std::vector<Eigen::Index> free_parameters(const std::vector<bool>& held) {
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < held.size(); ++k)
    if (!held[k]) free.push_back(static_cast<Eigen::Index>(k));
  return free;
}

/// |r|^2 that a Gauss-Newton step of the parameters that are not held, from where the problem was
/// evaluated last, would take away.
double decrement(const ScaledProblem& scaled, const std::vector<bool>& held) {
  const std::vector<Eigen::Index> free = free_parameters(held);
  if (free.empty()) return 0;
  const Eigen::MatrixXd columns = scaled.jacobian()(Eigen::all, free);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::VectorXd projected = qr.householderQ().transpose() * scaled.residual();
  return projected.head(std::min(columns.rows(), columns.cols())).squaredNorm();
}

class StopAtSmallDecrement final : public ceres::IterationCallback {
 public:
  StopAtSmallDecrement(const ScaledProblem& scaled, const std::vector<bool>& held, double tolerance)
      : scaled_(scaled), held_(held), tolerance_(tolerance) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    failed_ = summary.step_is_successful ? 0 : failed_ + 1;
    const bool done =
        failed_ == 0 ? decrement(scaled_, held_) < tolerance_ : failed_ >= kMostFailedSteps;
    return done ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  static constexpr int kMostFailedSteps = 4;
  const ScaledProblem& scaled_;
  const std::vector<bool>& held_;
  double tolerance_;
  int failed_ = 0;
};

ceres::Solver::Options ceres_options(const NonlinearOptions& options, double first_radius) {
  ceres::Solver::Options ceres;
  ceres.linear_solver_type = ceres::DENSE_QR;
  ceres.num_threads = 1;
  ceres.initial_trust_region_radius = first_radius;
  ceres.logging_type = ceres::SILENT;
  ceres.max_num_iterations = options.max_iterations;
  ceres.max_num_consecutive_invalid_steps = 20;
  ceres.function_tolerance = options.function_tolerance;
  ceres.parameter_tolerance = options.parameter_tolerance;
  if (!options.thorough) ceres.max_num_line_search_step_size_iterations = 0;
  ceres.gradient_tolerance = 0;  // has a unit; the two others say it all
  return ceres;
}

/// With those parameters held that `held` says.
void minimise(ScaledProblem& scaled, const NonlinearProblem& problem,
              const NonlinearOptions& options, double first_radius, const std::vector<bool>& held,
              Eigen::VectorXd& u, NonlinearSolution& out) {
  const Eigen::Index p = u.size();
  ceres::Problem ceres_problem;
  ceres_problem.AddResidualBlock(new Cost(&scaled, problem.n_residuals, p), nullptr, u.data());
  for (int k = 0; k < p; ++k) {
    if (scaled.lower(k) > -kUnbounded)
      ceres_problem.SetParameterLowerBound(u.data(), k, scaled.lower(k));
    if (scaled.upper(k) < kUnbounded)
      ceres_problem.SetParameterUpperBound(u.data(), k, scaled.upper(k));
  }
  std::vector<int> constant;
  for (int k = 0; k < p; ++k)
    if (held[static_cast<std::size_t>(k)]) constant.push_back(k);
  if (!constant.empty())
    ceres_problem.SetManifold(u.data(), new ceres::SubsetManifold(static_cast<int>(p), constant));
  ceres::Solver::Summary summary;
  ceres::Solver::Options ceres = ceres_options(options, first_radius);
  StopAtSmallDecrement stop(scaled, held, options.decrement_tolerance);
  if (options.decrement_tolerance > 0) ceres.callbacks.push_back(&stop);
  ceres::Solve(ceres, &ceres_problem, &summary);
  out.converged = summary.termination_type == ceres::CONVERGENCE ||
                  summary.termination_type == ceres::USER_SUCCESS;
  out.message = summary.termination_type == ceres::NO_CONVERGENCE
                    ? fmt::format("no convergence after {} iterations", options.max_iterations)
                    : summary.message;
}

std::vector<bool> on_bound(const ScaledProblem& scaled, const Eigen::VectorXd& u) {
  std::vector<bool> on;
  for (Eigen::Index k = 0; k < u.size(); ++k)
    on.push_back(u(k) <= scaled.lower(k) || u(k) >= scaled.upper(k));
  return on;
}

/// Releases the held parameter that would lower |r|^2 most, by its gradient, if any would; by no
/// less than `least` as far as the problem is linear in it.
bool release_one(const ScaledProblem& scaled, const Eigen::VectorXd& u, double least,
                 std::vector<bool>& held) {
  const Eigen::VectorXd gradient = scaled.jacobian().transpose() * scaled.residual();
  Eigen::Index best = -1;
  double most = 0;
  for (Eigen::Index k = 0; k < u.size(); ++k) {
    if (!held[static_cast<std::size_t>(k)]) continue;
    const double inward = u(k) <= scaled.lower(k) ? -gradient(k) : gradient(k);
    if (inward <= most || inward * inward < least * scaled.jacobian().col(k).squaredNorm())
      continue;
    most = inward;
    best = k;
  }
  if (best >= 0) held[static_cast<std::size_t>(best)] = false;
  return best >= 0;
}

/// Ceres alone comes near a minimum on a bound only slowly: what it leaves on a bound is held
/// there, and released again if that would help (an active set, Nocedal & Wright 2006, 16.5).
void minimise_on_bounds(ScaledProblem& scaled, const NonlinearProblem& problem,
                        const NonlinearOptions& options, double first_radius, Eigen::VectorXd& u,
                        NonlinearSolution& out) {
  std::vector<bool> held(static_cast<std::size_t>(u.size()), false);
  for (Eigen::Index i = 0; i <= 2 * u.size(); ++i) {
    minimise(scaled, problem, options, first_radius, held, u, out);
    const std::vector<bool> on = on_bound(scaled, u);
    if (on != held) {
      held = on;
      continue;
    }
    if (!scaled.evaluate(u, true) || !release_one(scaled, u, options.decrement_tolerance, held))
      return;
  }
}

/// A parameter could double, and |r| would hardly change beside what others do to it.
bool is_flat(const ScaledProblem& scaled, const Eigen::VectorXd& u) {
  const Eigen::VectorXd effect =
      scaled.jacobian().colwise().norm().transpose().cwiseProduct(u.cwiseAbs().cwiseMax(1.0));
  return u.size() > 0 && effect.minCoeff() < kFlat * effect.maxCoeff();
}

void judge_minimum(const ScaledProblem& scaled, const NonlinearProblem& problem,
                   NonlinearSolution& out) {
  const std::vector<Eigen::Index> free = free_parameters(out.at_bound);
  const auto n_free = static_cast<Eigen::Index>(free.size());
  const Eigen::MatrixXd& jacobian = scaled.jacobian();
  Eigen::MatrixXd columns(std::max(jacobian.rows(), n_free), n_free);
  columns.setZero();
  std::vector<NamedColumn> names;
  for (Eigen::Index k = 0; k < n_free; ++k) {
    const Eigen::Index from = free[static_cast<std::size_t>(k)];
    columns.col(k).head(jacobian.rows()) = jacobian.col(from);
    names.push_back({problem.names[static_cast<std::size_t>(from)], {}});
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd r = qr.matrixQR().topRows(n_free).triangularView<Eigen::Upper>();
  const ScaledSolve solved = solve_scaled(r, Eigen::VectorXd::Zero(n_free), problem.rank_tolerance);
  const std::vector<std::string> texts =
      not_determined(solved.null_directions, columns.colwise().norm(), names);
  out.rank = n_free - solved.null_directions.cols();
  out.condition_scaled = solved.condition_scaled;
  for (Eigen::Index i = 0; i < n_free; ++i) {
    const Eigen::Index row = free[static_cast<std::size_t>(i)];
    out.not_identifiable[static_cast<std::size_t>(row)] = texts[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n_free; ++j) {
      const Eigen::Index column = free[static_cast<std::size_t>(j)];
      out.inverse(row, column) =
          solved.inverse(i, j) * scaled.scale()(row) * scaled.scale()(column);
    }
  }
}

NonlinearSolution solve_with(ScaledProblem& scaled, const NonlinearProblem& problem,
                             const NonlinearOptions& options, double first_radius) {
  const Eigen::Index p = problem.start.size();
  NonlinearSolution out;
  out.inverse = Eigen::MatrixXd::Zero(p, p);
  out.not_identifiable.assign(problem.names.size(), "");
  Eigen::VectorXd u = scaled.start();
  if (p > 0) minimise_on_bounds(scaled, problem, options, first_radius, u, out);
  out.x = scaled.unscaled(u);
  scaled.evaluate(u, true);
  out.rss = scaled.residual().squaredNorm();
  out.at_bound = on_bound(scaled, u);
  judge_minimum(scaled, problem, out);
  out.is_flat = is_flat(scaled, u);
  out.decrement = decrement(scaled, out.at_bound);
  return out;
}

}  // namespace

NonlinearSolution solve(const NonlinearProblem& problem, const NonlinearOptions& options) {
  assert(problem.names.size() == static_cast<std::size_t>(problem.start.size()));
  assert(problem.evaluate);
  ScaledProblem scaled(problem);
  NonlinearSolution best;
  best.x = problem.start;
  best.inverse = Eigen::MatrixXd::Zero(problem.start.size(), problem.start.size());
  best.not_identifiable.assign(problem.names.size(), "");
  best.at_bound.assign(problem.names.size(), false);
  if (!scaled.evaluate(scaled.start(), true)) {
    best.message = "the residual has no value at the start";
    return best;
  }
  // A first step too long may end where the model is flat, and its Jacobian without rank.
  const auto ended_well = [](const NonlinearSolution& s) {
    return !s.is_flat && s.rank == std::count(s.at_bound.begin(), s.at_bound.end(), false);
  };
  bool is_first = true;
  for (const double radius : kFirstRadii) {
    const NonlinearSolution found = solve_with(scaled, problem, options, radius);
    if (is_first || found.rss < best.rss) best = found;
    is_first = false;
    if (!options.thorough || ended_well(best)) break;
  }
  best.n_evaluations = scaled.n_evaluations();
  return best;
}

}  // namespace cablefit
