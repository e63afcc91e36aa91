// One simulation of the windows of all logs: what their rows add up to. Internal to output_error/.
#pragma once

#include <vector>

#include "cablefit/dynamic/output_error/prediction_filter.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

struct PassSettings {
  FilterSettings filter;
  std::size_t every = 1;  ///< window is looked at; at most as many as there are
  int threads = 1;
};

struct WindowPass {
  bool valid = false;                      ///< nothing diverged
  RowStatistics statistics{1, 1, false};   ///< whitened; columns: parameters, then the residual
  double lag_product = 0, lag_square = 0;  ///< of residuals a row apart, and of each with itself

  /// Of whitened residuals a row apart.
  double correlation() const { return lag_square > 0 ? lag_product / lag_square : 0; }
};

/// `values`: of `parameters`. Windows side by side on `threads`, added up in order: the same bits
/// for any number of them.
WindowPass pass_over(const std::vector<OutputErrorWindow>& windows, const Model& model,
                     const std::vector<ModelParameter>& parameters, const Eigen::VectorXd& values,
                     const NoiseLevels& noise, const PassSettings& settings);

/// Columns: parameters, the residual, then the parameters once more along the motion of
/// `noise_free`, the same windows with noise-free positions: instruments, whitened like the rest.
/// They are not correlated with what disturbs the drive, as the parameters' own columns are. No
/// rows where something diverged.
RowStatistics instrumented_pass(const std::vector<OutputErrorWindow>& windows,
                                const std::vector<OutputErrorWindow>& noise_free,
                                const Model& model, const std::vector<ModelParameter>& parameters,
                                const Eigen::VectorXd& values, const NoiseLevels& noise,
                                const PassSettings& settings);

}  // namespace cablefit
