// One parameter of a solution as an estimate: value, robust sd, 95 % interval, bound.
#pragma once

#include "cablefit/base/axes.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// Which sd to report, and what else is uncertain.
struct SdChoice {
  bool robust = true;         ///< else the white one, the paper's (25)
  double extra_variance = 0;  ///< from an earlier stage, added to the robust one
};

/// ci_low, ci_high: value -+ t sd with Student's t of so many degrees of freedom, never below
/// `lower`.
void set_interval(Estimate& e, double degrees_of_freedom, double lower = -kUnbounded);

/// value, ci_low, ci_high of a parameter on its lower bound 0, sd being that of the fit without
/// bounds, whose value is `unbounded`: one-sided, and never shorter than t sd.
void set_on_bound(Estimate& e, double unbounded, double degrees_of_freedom);

/// The interval of a profile, never below `lower`, both ends further off by sqrt(1 + extra), the
/// relative variance that the profile does not know of. An interval without an end stays as it is.
void set_profile(Estimate& e, const ProfileInterval& profile, double extra, double lower);

/// Multiplies sd and interval with `factor` >= 1. An interval at a bound, or cut off there, grows
/// upwards.
void widen_interval(Estimate& e, double factor);

/// Parameter `k` of the solution, its interval by profile where the solution has profiles. On its
/// bound, 0, see set_on_bound(). Held at 0 by constraints instead, it has no sd.
Estimate estimate_of(const ParameterInfo& info, Axes axes, const LinearSolution& solution,
                     Eigen::Index k, const SdChoice& choice);

/// Whether the active bounds determine the value: its interval by profile, in which they may be
/// left, is ten times wider than the one by its sd, which holds them fixed.
bool is_held_by_bounds(const Estimate& e, double degrees_of_freedom);

}  // namespace cablefit
