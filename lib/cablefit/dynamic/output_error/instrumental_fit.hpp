// Output error with instruments, for disturbances that return through the controller. Such a
// disturbance moves the robot, so the columns of the parameters are correlated with the residual.
// Least squares of the whitened residual then finds the inertia too small (J -0.5 % at 5 % of
// disturbance). The remedy is Z'r = 0 with the columns Z of a noise-free loop in place of J'r = 0
// (Soderstrom & Stoica 1983, ch. 4; Janot, Vandanjon & Gautier 2014). Internal to output_error/.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

/// Whitened rows [J | r | Z] at given parameters: of the logs, and of a prior, which is its own
/// instrument.
struct InstrumentedSums {
  RowStatistics rows{1, 1, false};
  Eigen::MatrixXd prior;  ///< rows x (p + 1), may be empty
};

struct InstrumentalFit {
  std::string failure;  ///< why there is no fit; empty: there is one
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance, covariance_white;  ///< p x p, 0 for parameters that do not move
  double degrees_of_freedom = 0, effective_rows = 0;
  int n_passes = 0;
};

/// Newton steps from `start` until they are short. Only parameters with `moves` move. `sums`: at
/// these parameters; no rows: the simulation diverged.
InstrumentalFit solve_instrumental(
    const Eigen::VectorXd& start, const std::vector<bool>& moves,
    const std::function<InstrumentedSums(const Eigen::VectorXd&)>& sums);

}  // namespace cablefit
