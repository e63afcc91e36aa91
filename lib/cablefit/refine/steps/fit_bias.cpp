#include "cablefit/refine/steps/fit_bias.hpp"

#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"

namespace cablefit {
namespace {

/// Values anywhere, as they are simulated and fitted again.
struct Values {
  Design design;
  Eigen::VectorXd x;
};

std::optional<ValueChange> bias_at(const RefineBench& bench, const Values& values,
                                   const KindLevels& levels) {
  const std::vector<Model> models = recorded_models(models_with(values.design, values.x));
  Eigen::VectorXd recorded = values.x;
  forget_unrecorded(values.design, recorded);
  const int threads = bench.options.threads;
  try {
    NullBench copy(models, bench.logs, bench.wanted, values.design.smoothing, threads);
    copy.hold_back(bench.held_back);
    copy.silence_torque();  // its noise has no bias to give; without it one draw is enough
    const Design design =
        design_like(values.design, recorded, models, copy.draw(bench.seed, threads));
    if (design.n_columns() != recorded.size()) return {};
    auto bias = change_to_fit(design, recorded, levels, bench.scan.block_seconds, is_unrecorded);
    if (bias) forget_unrecorded(values.design, bias->x);
    return bias;
  } catch (const Error&) {
    return {};
  }
}

/// Whether the bias at the shapes without it is another one.
bool is_far(const Design& design, const ValueChange& bias) {
  constexpr double kFar = 0.05;
  const std::vector<FreeShape> all = free_shapes(design);
  for (std::size_t k = 0; k < all.size(); ++k)
    if (std::abs(bias.shapes(static_cast<Eigen::Index>(k))) > kFar * unit_of(design, all[k]))
      return true;
  return false;
}

}  // namespace

std::optional<ValueChange> fit_bias(const RefineBench& bench, const RefineState& state) {
  if (bench.elastic_only) return {};
  auto here = bias_at(bench, {state.design, state.x}, state.levels);
  if (!here || !is_far(state.design, *here)) return here;
  const Eigen::VectorXd x = state.x - here->x;
  auto there = bias_at(bench, {with_shapes(state.design, -here->shapes, x), x}, state.levels);
  return there ? there : here;
}

bool simulates_better_without(const RefineBench& bench, const RefineState& state,
                              const ValueChange& bias) {
  const auto gap = [&](const Design& design, const Eigen::VectorXd& x) {
    return simulated_gap(models_with(design, x), bench.logs, bench.options.threads);
  };
  const Eigen::VectorXd x = state.x - bias.x;
  const SimulatedGap less = gap(with_shapes(state.design, -bias.shapes, x), x);
  if (!less.known() || !bench.simulation_floor.known()) return false;
  const SimulatedGap as_fitted = gap(state.design, state.x);
  return !as_fitted.known() ||
         in_floors(less, bench.simulation_floor) < in_floors(as_fitted, bench.simulation_floor);
}

RefineState without_bias(const RefineState& state, const ValueChange& bias) {
  RefineState out = state;
  out.x = state.x - bias.x;
  out.design = with_shapes(std::move(out.design), -bias.shapes, out.x);
  return out;
}

}  // namespace cablefit
