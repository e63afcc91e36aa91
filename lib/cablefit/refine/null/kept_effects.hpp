// Effects that the models have from an earlier refinement. They are part of the base, and their
// columns are refitted with all others. Internal to refine/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/refine/null/null_draws.hpp"

namespace cablefit {

/// Kept effects of a model as variants, in the plain form where their values are those of the plain
/// form. Changed cables are in the transmission already and give no variants.
std::vector<Variant> kept_variants(const Model& model);

/// The models without kept effects, as designs contain them.
std::vector<Model> without_kept(std::span<const Model> models);

/// The design with these variants, added one after the other. Its models already have their cables.
/// `values`: of all columns, or of the first ones.
Design with_variants(Design design, const std::vector<Variant>& variants,
                     const Eigen::VectorXd& values);

/// The same columns for other stretches. `bases`: the design's models with the values `x`.
Design design_like(const Design& design, const Eigen::VectorXd& x, std::span<const Model> bases,
                   std::vector<Stretch> stretches);

/// A design of models with all their effects.
Design design_of(std::span<const Model> models, std::vector<Stretch> stretches,
                 const Smoothing& smoothing);

/// A base fit with the models' kept effects, and the design without them.
struct KeptBase {
  BaseFit base;
  Design bare;
  std::vector<std::string> warnings;
};

/// The warning for an effect that was removed because its coefficient is beyond its physical bound.
std::string taken_out(const Effect& row);

/// The nonlinear parameters of the effects are fitted too. An effect beyond its physical bound in
/// these rows is removed, with a warning. Throws Error(not_identifiable) where the rows do not
/// separate an effect from the other columns.
KeptBase fit_kept_base(std::span<const Model> models, std::vector<Stretch> stretches,
                       const Smoothing& smoothing, const ScanSettings& settings);

}  // namespace cablefit
