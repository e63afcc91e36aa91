// One simulation of the windows of all logs, and the sums over their rows. Internal to
// output_error/.
#pragma once

#include <vector>

#include "cablefit/dynamic/output_error/prediction_filter.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

struct PassSettings {
  FilterSettings filter;
  std::size_t every = 1;  ///< uses every n-th window; at most as many as there are
  int threads = 1;
};

struct WindowPass {
  bool valid = false;                      ///< nothing diverged
  RowStatistics statistics{1, 1, false};   ///< whitened; columns: parameters, then the residual
  double lag_product = 0, lag_square = 0;  ///< sums: residuals one row apart, and squares

  /// Correlation of whitened residuals one row apart.
  double correlation() const { return lag_square > 0 ? lag_product / lag_square : 0; }
};

/// `values`: of `parameters`. Windows run in parallel on `threads` and are added in order: the same
/// bits for any number of threads.
WindowPass pass_over(const std::vector<OutputErrorWindow>& windows, const Model& model,
                     const std::vector<ModelParameter>& parameters, const Eigen::VectorXd& values,
                     const NoiseLevels& noise, const PassSettings& settings);

/// Columns: parameters, the residual, then the parameters again along the motion of `noise_free`,
/// the same windows with noise-free positions. The last are instruments, whitened like the rest.
/// Unlike the parameters' own columns they are not correlated with disturbances of the drive. No
/// rows where a simulation diverged.
RowStatistics instrumented_pass(const std::vector<OutputErrorWindow>& windows,
                                const std::vector<OutputErrorWindow>& noise_free,
                                const Model& model, const std::vector<ModelParameter>& parameters,
                                const Eigen::VectorXd& values, const NoiseLevels& noise,
                                const PassSettings& settings);

}  // namespace cablefit
