#include "cablefit/refine/steps/best_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr int kSteps = 4;
constexpr double kLongestStep = 0.3, kNothing = 1e-3;  // of the unit of a shape

/// No step longer than what the derivative holds for.
void shorten(const Design& design, Eigen::VectorXd& shapes) {
  const std::vector<FreeShape> all = free_shapes(design);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const double most = kLongestStep * unit_of(design, all[k]);
    double& step = shapes(static_cast<Eigen::Index>(k));
    step = std::clamp(step, -most, most);
  }
}

/// The largest step in units of its shape.
double largest(const Design& design, const Eigen::VectorXd& shapes) {
  const std::vector<FreeShape> all = free_shapes(design);
  double most = 0;
  for (std::size_t k = 0; k < all.size(); ++k)
    most = std::max(most, std::abs(shapes(static_cast<Eigen::Index>(k))) / unit_of(design, all[k]));
  return most;
}

bool none_is_fixed(const Effect& /*row*/) { return false; }

}  // namespace

RefineState with_best_shapes(const RefineBench& bench, RefineState state) {
  const double seconds = bench.scan.block_seconds;
  bool moved = false;
  const auto fitted = [&](const Design& design) {
    return fit_blocks(block_grams(design, seconds), state.levels, false);
  };
  auto best = fitted(state.design);
  for (int k = 0; best && k < kSteps; ++k) {
    auto step = change_to_fit(state.design, state.x, state.levels, seconds, none_is_fixed);
    if (!step || step->shapes.size() == 0) break;
    shorten(state.design, step->shapes);
    if (largest(state.design, step->shapes) < kNothing) break;
    Design design = with_shapes(state.design, step->shapes, state.x + step->x);
    auto fit = fitted(design);
    if (!fit || !(rho_of(*fit, bench.floor) < rho_of(*best, bench.floor))) break;
    state.design = std::move(design);
    state.x = fit->x;
    best = std::move(fit);
    moved = true;
  }
  if (moved) judge(bench, *best, state);
  return state;
}

}  // namespace cablefit
