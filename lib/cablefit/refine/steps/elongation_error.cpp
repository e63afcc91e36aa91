#include "cablefit/refine/steps/elongation_error.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/test_reading.hpp"

namespace cablefit {
namespace {

constexpr double kRounding = 1e-12;  // of the largest eigenvalue
constexpr double kSureSd = 2;

/// Makes each l_o longer by `step`; false: the design has none of these cables.
bool lengthen(const ElongationCovariance& known, const Eigen::VectorXd& step, Design& design) {
  bool any = false;
  for (std::size_t k = 0; k < known.of.size(); ++k)
    for (Model& model : design.models) {
      if (model.preload != known.of[k].preload) continue;
      for (Cable& cable : model.transmission.cables) {
        if (elongation_name(cable) != known.of[k].name) continue;
        cable.initial_elongation += step(static_cast<Eigen::Index>(k));
        any = true;
      }
    }
  return any;
}

bool has_sure_size(const NamedEffect& effect) {
  const std::vector<Estimate>& all = effect.instance.parameters;
  return std::any_of(all.begin(), all.end(), [](const Estimate& e) {
    return e.sd > 0 && std::abs(e.value) > kSureSd * e.sd;
  });
}

}  // namespace

void add_systematic(const ValueChange& error, FinalFit& fit) {
  Eigen::VectorXd all(error.x.size() + error.shapes.size());
  all << error.x, error.shapes;
  fit.covariance.topLeftCorner(all.size(), all.size()) += all * all.transpose();
}

bool add_elongation_errors(const Design& design, const Eigen::VectorXd& x, const KindLevels& levels,
                           const RefineBench& bench, FinalFit& fit) {
  const ElongationCovariance& known = bench.options.elongations;
  if (known.empty() || design.models.front().transmission.cables.empty()) return true;
  const auto change = [&](const Design& of) {
    return change_to_fit(of, x, levels, bench.scan.block_seconds, is_unrecorded);
  };
  const Design as_is = rebuilt(design, x);
  const auto here = change(as_is);
  if (!here) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(known.matrix);
  const Eigen::VectorXd& variance = eigen.eigenvalues();
  for (Eigen::Index axis = 0; axis < variance.size(); ++axis) {
    if (variance(axis) <= kRounding * variance.maxCoeff()) continue;
    Design moved = as_is;
    if (!lengthen(known, std::sqrt(variance(axis)) * eigen.eigenvectors().col(axis), moved))
      continue;
    const auto there = change(rebuilt(moved, x));
    if (!there) return false;
    add_systematic({there->x - here->x, there->shapes - here->shapes}, fit);
  }
  return true;
}

void require_more_than_elongations(const RefineBench& bench, Chain& chain, RefineResult& result) {
  if (bench.options.elongations.empty()) return;
  while (!result.effects.empty()) {
    const RefineState& last = chain.back();
    const Design& undone = bench.n_kept == 0 ? chain.front().design : bench.bare;
    FinalFit fit = final_fit(undone, last.design, last.levels, bench.scan.block_seconds);
    add_elongation_errors(last.design, fit.x, last.levels, bench, fit);
    const std::vector<NamedEffect> named = named_effects(last.design, fit);
    if (std::all_of(named.end() - static_cast<std::ptrdiff_t>(result.effects.size()), named.end(),
                    has_sure_size))
      return;
    // Later effects were found with the earlier ones in the model.
    const bool goes_with_others = last.is_joint || has_sure_size(named.back());
    constexpr const char* kReason = "the error of the searched l_o is as large as its coefficients";
    drop_last(kReason, chain, result);
    while (goes_with_others && !result.effects.empty()) drop_last(kReason, chain, result);
    require_half_explained(chain, result);
  }
}

}  // namespace cablefit
