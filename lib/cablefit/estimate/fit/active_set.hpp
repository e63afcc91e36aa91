// Which parameters of a linear problem may still move where its inequalities hold them. Internal to
// estimate/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// Parameters that may move, as positions within problem.regressors: x(free) = basis * z. All
/// others are 0.
struct Freedom {
  std::vector<Eigen::Index> free;
  std::optional<Eigen::MatrixXd> basis;  ///< free.size() x z.size(); none: x(free) = z

  int n_tied() const;  ///< directions fewer than free parameters
};

struct ActiveSet {
  bool empty = true;
  std::vector<Eigen::Index> constraints;  ///< rows of problem.constraints
  Freedom freedom;                        ///< once active constraints and bounds are equalities
};

/// All inequalities on the free parameters as rows: g x(free) >= 0; bounds first.
Eigen::MatrixXd inequality_rows(const LinearProblem& problem,
                                const std::vector<Eigen::Index>& free);

/// Of min |a x(free) - b| under the bounds and constraints of `problem`; empty when `x`, the
/// solution without them, satisfies them all.
ActiveSet find_active_set(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                          const Eigen::VectorXd& x, const LinearProblem& problem,
                          const std::vector<Eigen::Index>& free);

}  // namespace cablefit
