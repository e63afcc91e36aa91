#include "cablefit/refine/fit_bias.hpp"

#include "cablefit/base/error.hpp"
#include "cablefit/refine/refined_model.hpp"

namespace cablefit {
namespace {

/// What a recorder of the simulated model would see too: not what happened once, and not what is
/// wrong with the recorder.
bool is_recorded(const Refinement& row) { return !row.is_event && row.site != Site::sensor; }

std::vector<Model> recorded_models(const RefineState& state) {
  std::vector<Model> models = models_with(state.design, state.x);
  for (Model& model : models)
    std::erase_if(model.joints.front().refinements, [](const RefinementInstance& instance) {
      return !is_recorded(*instance.refinement);
    });
  return models;
}

/// The same columns over other stretches. `bases`: the models with the state's values.
Design design_like(const RefineState& state, std::vector<Model> bases,
                   std::vector<Stretch> stretches) {
  for (Model& model : bases) model.joints.front().refinements.clear();
  Design design = make_design(bases, std::move(stretches), state.design.smoothing);
  for (const Variant& variant : state.design.added) {
    if (variant.refinement->change != nullptr)
      design.added.push_back(variant);  // the models have these cables
    else
      design = with_variant(design, variant, state.x.head(design.n_columns()));
  }
  return design;
}

void forget_unrecorded(const Design& design, Eigen::VectorXd& bias) {
  Eigen::Index at = design.layout.n();
  for (const Variant& variant : design.added) {
    const Eigen::Index n = n_linear(variant);
    if (!is_recorded(*variant.refinement)) bias.segment(at, n).setZero();
    at += n;
  }
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
