// Are the regressors correlated with the residual? Then least squares is biased, whatever its
// standard deviations say, and instruments are needed.
#pragma once

#include <string>

#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

struct ExogeneityTest {
  bool possible = false;  ///< there was an instrument apart from the regressors
  double statistic = 0;   ///< F
  double dof_numerator = 0, dof_denominator = 0;
  double p_value = 1;

  /// "p = 0.4", "p < 0.001"
  std::string p_text() const;
};

/// Revised Durbin-Wu-Hausman test (Janot, Vandanjon & Gautier 2016; Wu 1973; Hausman 1978) in the
/// form of an augmented regression: y on [W Z]. Given instruments uncorrelated with the residual,
/// Z adds nothing to W exactly when W is uncorrelated with it too. What Z adds is tested with the
/// robust covariance, so that coloured residuals do not make it too eager. `problem`: with
/// instruments; its bounds are left out.
ExogeneityTest test_exogeneity(const RowStatistics& rows, const LinearProblem& problem);

/// What differences between estimates with and without instruments matter, however certain long
/// logs make them. Below half an sd least squares stands: that costs its 95 % intervals 3 % of
/// their coverage. Above that its intervals miss, and instruments are used; but below half a per
/// cent inertias and frictions serve their purpose all the same, and the verdict says so.
struct Materiality {
  double sd = 0.5;
  double relative = 0.005;
};

/// What instruments change in one parameter.
struct EstimateDifference {
  Eigen::Index parameter = -1;  ///< -1: there is none with an sd
  double in_sd = 0;             ///< of the fit without instruments, signed
  double relative = 0;          ///< of the estimate with instruments, signed
};

/// Of the parameter that differs most in sd. Both of the same problem, but for the instruments.
EstimateDifference largest_difference(const LinearSolution& plain, const LinearSolution& with);

enum class Difference { none, small, material };
/// none: below the limit in sd, whatever it is relative to a parameter that is badly known; small:
/// above it, but below the relative one.
Difference judge_difference(const EstimateDifference& difference, const Materiality& limits = {});

/// A determined parameter's instruments hardly move as its regressor does: estimates by them lean
/// towards least squares and their intervals are too short.
bool has_weak_instruments(const LinearSolution& solution);

}  // namespace cablefit
