// From the last pass of an output-error fit to parameters with intervals. Internal to
// output_error/.
#pragma once

#include "cablefit/dynamic/output_error/output_error.hpp"
#include "cablefit/dynamic/output_error/window_pass.hpp"
#include "cablefit/estimate/fit/nonlinear_least_squares.hpp"

namespace cablefit {

/// The end point of a fit.
struct FinalRows {
  const std::vector<ModelParameter>& parameters;
  const WindowPass& pass;        ///< at solution.x
  const Eigen::MatrixXd& prior;  ///< whitened rows of the prior at solution.x
  const NonlinearSolution& solution;
};

/// Fills the residuals and parameters of `fit`; `fit.model` has their values. There must be more
/// rows than parameters.
void fill_estimates(const FinalRows& last, OutputErrorFit& fit);

}  // namespace cablefit
