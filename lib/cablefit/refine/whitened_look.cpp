#include "cablefit/refine/whitened_look.hpp"

#include "cablefit/refine/fit_bias.hpp"
#include "cablefit/refine/refined_model.hpp"
#include "cablefit/refine/remainder.hpp"
#include "cablefit/refine/unexplained.hpp"

namespace cablefit {
namespace {

/// Squared, in units of each kind's level, summed.
double size_of(const Design& design, const VariantColumns& torques, const KindLevels& levels) {
  double sum = 0;
  for (std::size_t s = 0; s < torques.size(); ++s)
    for (std::size_t k = 0; k < torques[s].size(); ++k) {
      const double level = levels[static_cast<std::size_t>(design.rows[s].kinds[k].kind)];
      sum += torques[s][k].squaredNorm() / (level * level);
    }
  return sum;
}

/// Torque of a candidate in every row, N m: of its columns, or what its rows do to the residual.
/// `x`: of the design without it.
VariantColumns torques_of(const Design& design, const Candidate& c, const Eigen::VectorXd& x) {
  VariantColumns torques;
  if (!replaces_rows(c.variant)) {
    torques = variant_columns(design, c.variant, x);
    for (auto& kinds : torques)
      for (Eigen::MatrixXd& torque : kinds) torque *= c.x.tail(n_linear(c.variant));
    return torques;
  }
  torques = residuals(replaced_rows(design, c.variant), c.x);
  // Other cables may have more coefficients, and the others then have to be as they were fitted.
  const VariantColumns before = residuals(design.rows, c.x.size() == x.size() ? c.x : x);
  for (std::size_t s = 0; s < torques.size(); ++s)
    for (std::size_t k = 0; k < torques[s].size(); ++k) torques[s][k] -= before[s][k];
  return torques;
}

}  // namespace

std::optional<RefineState> whitened(RefineBench& bench, const RefineState& state) {
  const double seconds = bench.scan.block_seconds;
  // A mode or a hum goes on as the motion or a clock has it, not by chance.
  const auto left = describe_remainder(state.design, state.x, bench.floor, seconds);
  if (!left || left->kind != "wandering") return {};
  KindMemory memory = memory_of(state.design, state.x);
  for (std::size_t k = 0; k < kRowKinds; ++k)
    if (to_string(static_cast<RowKind>(k)) != left->equation) memory[k] = {};
  Design noise = bench.noise.design;
  noise.whitening = whitening_of(memory, memory_of(noise, bench.noise.fit.x), seconds);
  if (!noise.whitening.is_needed()) return {};
  need_disturbance(bench, state, bench.first_search);
  bench.white_floor = positive(rms_of(block_grams(noise, seconds), bench.noise.fit.x));

  RefineState white = state;
  white.design.whitening = white.test.whitening = noise.whitening;
  const BlockGrams grams = block_grams(white.design, seconds);
  white.levels = at_least(rms_of(grams, state.x), bench.white_floor);
  const auto fit = fit_blocks(grams, white.levels, false);
  if (!fit) return {};
  white.x = fit->x;
  white.rho = bench.rho(white.design, *fit);
  white.simulated = bench.simulated(models_with(white.design, white.x));
  // An effect has to fit and simulate better than either.
  if (RowGap unseen = gap_of(white.test, white.x, bench.test_floor, seconds);
      unseen.rho < white.unseen.rho)
    white.unseen = std::move(unseen);
  white.simulated = smaller(white.simulated, state.simulated, bench.simulation_floor);
  white.simulated_before = simulated_best(bench, state, bench.base_bias);
  return white;
}

void refuse_small(const Design& design, Search& found, double least) {
  const Eigen::VectorXd& x = found.fit.x;
  const VariantColumns left = residuals(design.rows, x);
  const KindLevels levels = positive(rms_of(block_grams(design.rows, design.stretches, 1), x));
  const double all = size_of(design, left, levels);
  for (Candidate& c : found.candidates)
    if (c.refused.empty() && c.gain > 0 &&
        size_of(design, torques_of(design, c, x), levels) < least * all)
      c.refused = "too small to matter";
}

}  // namespace cablefit
