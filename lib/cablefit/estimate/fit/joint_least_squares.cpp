#include "cablefit/estimate/fit/joint_least_squares.hpp"

#include <cassert>
#include <cmath>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/fit/profile_interval.hpp"
#include "cablefit/estimate/solve/constrained_least_squares.hpp"
#include "cablefit/estimate/solve/null_space.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"
#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {
namespace {

// A combination's share in a null direction (both of unit norm, scaled) that is rounding.
constexpr double kNullShare = 1e-6;

struct Stack {
  Eigen::MatrixXd a;  ///< rows x n_params, columns of unit norm
  Eigen::VectorXd b;
  Eigen::VectorXd norm;
};

Stack stack_of(const JointProblem& problem) {
  Eigen::Index n = 0;
  for (const JointBlock& block : problem.blocks) n += block.rows->n_columns();
  // At least as many rows as parameters, as QR wants; rows of zeros say nothing.
  Stack stack{Eigen::MatrixXd::Zero(std::max(n, problem.n_params()), problem.n_params()),
              Eigen::VectorXd::Zero(std::max(n, problem.n_params())),
              {}};
  Eigen::Index first = 0;
  for (const JointBlock& block : problem.blocks) {
    const double root = std::sqrt(block.weight);
    const Eigen::Index rows = block.rows->n_columns();
    stack.a.middleRows(first, rows).noalias() = root * block.rows->r() * block.regressors;
    stack.b.segment(first, rows).noalias() = root * block.rows->r() * block.response;
    first += rows;
  }
  stack.norm = stack.a.colwise().norm();
  for (double& norm : stack.norm)
    if (!(norm > 0)) norm = 1;
  stack.a = stack.a * stack.norm.cwiseInverse().asDiagonal();
  return stack;
}

/// What the equalities leave free; those without any parameter say nothing.
Eigen::MatrixXd free_directions(Eigen::MatrixXd rows) {
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    if (rows.row(i).norm() > 0) rows.row(i).normalize();
  return null_space(rows);
}

Eigen::MatrixXd with_rows(const Eigen::MatrixXd& top, const Eigen::MatrixXd& all,
                          const std::vector<Eigen::Index>& which, Eigen::Index columns) {
  Eigen::MatrixXd rows(top.rows() + static_cast<Eigen::Index>(which.size()), columns);
  if (top.rows() > 0) rows.topRows(top.rows()) = top;
  for (std::size_t k = 0; k < which.size(); ++k)
    rows.row(top.rows() + static_cast<Eigen::Index>(k)) = all.row(which[k]);
  return rows;
}

/// Rows of inequalities that the fit on `z` would break, with nothing held by them yet: all.
std::vector<Eigen::Index> find_active(const Stack& stack, const Eigen::MatrixXd& z,
                                      const Eigen::MatrixXd& scaled_inequalities) {
  Eigen::MatrixXd g = scaled_inequalities * z;
  for (Eigen::Index i = 0; i < g.rows(); ++i)
    if (g.row(i).norm() > 0) g.row(i).normalize();
  return constrained_least_squares(stack.a * z, stack.b, g).active;
}

void finish(const JointProblem& problem, const Stack& stack, const Eigen::MatrixXd& z,
            JointSolution& out) {
  const ScaledSolve free = solve_scaled(stack.a * z, stack.b);
  const auto unscale = stack.norm.cwiseInverse().asDiagonal();
  out.column_norm = stack.norm;
  out.x = z.cols() > 0 ? Eigen::VectorXd(unscale * (z * free.x))
                       : Eigen::VectorXd::Zero(problem.n_params());
  out.solve_operator = Eigen::MatrixXd::Zero(problem.n_params(), problem.n_params());
  out.null_directions.resize(problem.n_params(), free.null_directions.cols());
  if (z.cols() > 0) {
    const Eigen::MatrixXd basis = unscale * z;
    out.solve_operator = basis * free.inverse * basis.transpose();
    Eigen::VectorXd norm = (stack.a * z).colwise().norm();
    for (double& n : norm)
      if (!(n > 0)) n = 1;
    out.null_directions = z * norm.cwiseInverse().asDiagonal() * free.null_directions;
    out.null_directions.colwise().normalize();
  }
  out.n_params = z.cols() - out.null_directions.cols();
  out.condition_scaled = free.condition_scaled;
  for (const JointBlock& block : problem.blocks) {
    out.combinations.push_back(block.response - block.regressors * out.x);
    out.rss.push_back((block.rows->r() * out.combinations.back()).squaredNorm());
    out.weighted_rss += block.weight * out.rss.back();
    out.n_rows += block.rows->n_rows();
  }
}

}  // namespace

bool JointSolution::determines(const Eigen::VectorXd& combination) const {
  const Eigen::VectorXd scaled = combination.cwiseQuotient(column_norm);
  const double size = scaled.norm();
  return null_directions.cols() == 0 ||
         (null_directions.transpose() * scaled).norm() <= kNullShare * size;
}

JointSolution solve(const JointProblem& problem) {
  const Stack stack = stack_of(problem);
  const auto unscale = stack.norm.cwiseInverse().asDiagonal();
  const Eigen::Index p = problem.n_params();
  Eigen::MatrixXd equalities(0, p), inequalities(0, p);
  if (problem.equalities.rows() > 0) equalities = problem.equalities * unscale;
  if (problem.inequalities.rows() > 0) inequalities = problem.inequalities * unscale;
  JointSolution out;
  Eigen::MatrixXd z = free_directions(equalities);
  if (inequalities.rows() > 0) {
    const Eigen::MatrixXd tied = z;
    out.active = find_active(stack, tied, inequalities);
    if (!out.active.empty())
      z = free_directions(with_rows(equalities, inequalities, out.active, p));
  }
  finish(problem, stack, z, out);
  return out;
}

std::vector<ProfileInterval> joint_profiles(const JointProblem& problem) {
  JointProblem free = problem;
  free.inequalities.resize(0, 0);
  const JointSolution s = solve(free);
  const JointCovariance covariance = joint_covariance(free, s);
  const Stack stack = stack_of(problem);
  const auto unscale = stack.norm.cwiseInverse().asDiagonal();
  Eigen::MatrixXd equalities(0, problem.n_params());
  if (problem.equalities.rows() > 0) equalities = problem.equalities * unscale;
  const Eigen::MatrixXd z = free_directions(equalities);
  const Eigen::MatrixXd a = stack.a * z, g = problem.inequalities * unscale * z;
  std::vector<ProfileInterval> all(static_cast<std::size_t>(problem.n_params()),
                                   {kNotKnown, kNotKnown});
  for (Eigen::Index k = 0; k < problem.n_params(); ++k) {
    const double plain = s.solve_operator(k, k), robust = covariance.covariance(k, k);
    if (!s.determines(Eigen::VectorXd::Unit(problem.n_params(), k)) || !(plain > 0)) continue;
    const double t = t_quantile_975(covariance.degrees_of_freedom(k));
    ProfileInterval& interval = all[static_cast<std::size_t>(k)];
    interval = profile_interval(a, stack.b, g, z.row(k), t * t * robust / plain);
    interval.low /= stack.norm(k);
    interval.high /= stack.norm(k);
  }
  return all;
}

}  // namespace cablefit
