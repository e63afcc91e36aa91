#include "cablefit/refine/fit_bias.hpp"

#include "cablefit/base/error.hpp"
#include "cablefit/refine/kept_effects.hpp"
#include "cablefit/refine/recorded_effects.hpp"
#include "cablefit/refine/refined_model.hpp"

namespace cablefit {
namespace {

std::vector<Model> recorded_models(const RefineState& state) {
  return cablefit::recorded_models(models_with(state.design, state.x));
}

/// The same columns over other stretches. `bases`: the models with the state's values.
Design design_like(const RefineState& state, std::span<const Model> bases,
                   std::vector<Stretch> stretches) {
  return with_variants(
      make_design(without_kept(bases), std::move(stretches), state.design.smoothing),
      state.design.added, state.x);
}

}  // namespace

std::optional<Eigen::VectorXd> fit_bias(const RefineBench& bench, const RefineState& state) {
  if (bench.elastic_only) return {};
  const std::vector<Model> models = recorded_models(state);
  const int threads = bench.options.threads;
  Eigen::VectorXd bias;
  try {
    NullBench twin(models, bench.logs, bench.wanted, state.design.smoothing, threads);
    twin.hold_back(bench.held_back);
    twin.silence_torque();  // its noise has no bias to give; without it one draw is enough
    const Design design = design_like(state, models, twin.draw(bench.options.seed, threads));
    const auto fit = fit_blocks(
        block_grams(design.rows, design.stretches, bench.scan.block_seconds), state.levels, false);
    if (!fit || fit->x.size() != state.x.size()) return {};
    bias = fit->x - state.x;
  } catch (const Error&) {
    return {};
  }
  forget_unrecorded(state.design, bias);
  return bias;
}

bool simulates_better_without(const RefineBench& bench, const RefineState& state,
                              const Eigen::VectorXd& bias) {
  const auto gap = [&](const Eigen::VectorXd& x) {
    return simulated_gap(models_with(state.design, x), bench.logs, bench.options.threads);
  };
  const SimulatedGap less = gap(state.x - bias);
  if (!less.known() || !bench.simulation_floor.known()) return false;
  const SimulatedGap as_fitted = gap(state.x);
  return !as_fitted.known() ||
         in_floors(less, bench.simulation_floor) < in_floors(as_fitted, bench.simulation_floor);
}

RefineState without_bias(const RefineBench& bench, const RefineState& state,
                         const Eigen::VectorXd& bias) {
  RefineState out = state;
  out.x = state.x - bias;
  out.simulated =
      simulated_gap(models_with(out.design, out.x), bench.unseen, bench.options.threads);
  if (state.simulated.known() && !out.simulated.known()) return state;
  out.unseen = gap_of(out.test, out.x, bench.test_floor, bench.scan.block_seconds);
  return out;
}

}  // namespace cablefit
