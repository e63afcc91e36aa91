// Bias of a fit by equation error from rounding, filters and reversals, and the values without it.
// The fitted model is simulated and fitted again; the change of the values is the bias (bootstrap;
// Efron & Tibshirani 1993, ch. 10). Only simulations show it, not the equations. Internal to
// refine/.
#pragma once

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// Bias of `state.x`, fitted with `state.levels`, and of the shapes of its design, to first order
/// in these. Events and sensors have none, because no simulated log shows them. Nothing when the
/// fitted model cannot be simulated, or with blocked logs alone.
std::optional<ValueChange> fit_bias(const RefineBench& bench, const RefineState& state);

/// Whether the values without it simulate the training logs better.
bool simulates_better_without(const RefineBench& bench, const RefineState& state,
                              const ValueChange& bias);

/// The state with its values less the bias. `rho`, `held_out` and `levels` stay those of the fit:
/// the floors of training rows include the same bias.
RefineState without_bias(const RefineState& state, const ValueChange& bias);

}  // namespace cablefit
