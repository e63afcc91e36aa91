#include "cablefit/estimate/fit/active_set.hpp"

#include <cassert>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/solve/constrained_least_squares.hpp"
#include "cablefit/estimate/solve/null_space.hpp"

namespace cablefit {
namespace {

// Share of a unit step that orthonormal directions leave a parameter: 1 or 0 up to rounding, unless
// it takes part in a tie, where scaled columns make it anything but tiny.
constexpr double kPinned = 1e-10;

/// All inequalities on the free parameters as rows: g x(free) >= 0. Bounds first.
struct Inequalities {
  Eigen::MatrixXd g;
  Eigen::Index n_bounds = 0;
};

Inequalities inequalities(const LinearProblem& problem, const std::vector<Eigen::Index>& free) {
  Inequalities all;
  std::vector<Eigen::Index> bounded;  // positions in `free`
  for (std::size_t k = 0; k < free.size() && !problem.lower.empty(); ++k) {
    const double lower = problem.lower[static_cast<std::size_t>(free[k])];
    assert(lower == 0 || lower == -kUnbounded);
    if (lower == 0) bounded.push_back(static_cast<Eigen::Index>(k));
  }
  all.n_bounds = static_cast<Eigen::Index>(bounded.size());
  all.g = Eigen::MatrixXd::Zero(all.n_bounds + problem.constraints.rows(),
                                static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < bounded.size(); ++i)
    all.g(static_cast<Eigen::Index>(i), bounded[i]) = 1;
  if (problem.constraints.rows() > 0)
    for (std::size_t k = 0; k < free.size(); ++k)
      all.g.col(static_cast<Eigen::Index>(k)).tail(problem.constraints.rows()) =
          problem.constraints.col(free[k]);
  return all;
}

/// What is left of the free parameters when ties * x(free) = 0. Some cannot move at all: they are
/// on their bound, exactly 0. Columns of `a` give the scale of the parameters.
Freedom freedom_under(const Eigen::MatrixXd& ties, const Eigen::MatrixXd& a,
                      const std::vector<Eigen::Index>& free) {
  Eigen::VectorXd norm = a.colwise().norm();
  for (double& n : norm)
    if (!(n > 0)) n = 1;
  Eigen::MatrixXd scaled = ties * norm.cwiseInverse().asDiagonal();
  scaled.rowwise().normalize();
  const Eigen::VectorXd reach = null_space(scaled).rowwise().norm();
  Freedom freedom;
  std::vector<Eigen::Index> moving;  // positions in `free`
  for (Eigen::Index k = 0; k < reach.size(); ++k) {
    if (reach(k) < kPinned) continue;
    moving.push_back(k);
    freedom.free.push_back(free[static_cast<std::size_t>(k)]);
  }
  const Eigen::MatrixXd left = scaled(Eigen::all, moving);
  if (left.size() == 0 || left.cwiseAbs().maxCoeff() < kPinned) return freedom;
  freedom.basis = norm(moving).cwiseInverse().asDiagonal() * null_space(left);
  return freedom;
}

}  // namespace

Eigen::MatrixXd inequality_rows(const LinearProblem& problem,
                                const std::vector<Eigen::Index>& free) {
  return inequalities(problem, free).g;
}

int Freedom::n_tied() const { return basis ? static_cast<int>(basis->rows() - basis->cols()) : 0; }

ActiveSet find_active_set(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                          const Eigen::VectorXd& x, const LinearProblem& problem,
                          const std::vector<Eigen::Index>& free) {
  ActiveSet set;
  const Inequalities all = inequalities(problem, free);
  if (all.g.rows() == 0 || (all.g * x).minCoeff() >= 0) return set;
  const std::vector<Eigen::Index> active = constrained_least_squares(a, b, all.g).active;
  if (active.empty()) return set;
  set.empty = false;
  for (const Eigen::Index i : active)
    if (i >= all.n_bounds) set.constraints.push_back(i - all.n_bounds);
  set.freedom = freedom_under(all.g(active, Eigen::all), a, free);
  return set;
}

}  // namespace cablefit
