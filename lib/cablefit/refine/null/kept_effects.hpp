// Effects that the models have from an earlier refinement: part of the base, with columns that are
// refitted with all others. Internal to refine/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/refine/null/null_draws.hpp"

namespace cablefit {

/// Those of a model as variants, in the plain form where the values are those of it. Other cables
/// are in the transmission already and no variants.
std::vector<Variant> kept_variants(const Model& model);

/// The models without them, as designs hold them.
std::vector<Model> without_kept(std::span<const Model> models);

/// The design with these in it, one after the other; its models have their cables already.
/// `values`: of all columns, or as many of the first as there are.
Design with_variants(Design design, const std::vector<Variant>& variants,
                     const Eigen::VectorXd& values);

/// The same columns over other stretches. `bases`: the design's models with the values `x`.
Design design_like(const Design& design, const Eigen::VectorXd& x, std::span<const Model> bases,
                   std::vector<Stretch> stretches);

/// A design of models with all they have.
Design design_of(std::span<const Model> models, std::vector<Stretch> stretches,
                 const Smoothing& smoothing);

/// A base fit with what the models have, and the design as it is without.
struct KeptBase {
  BaseFit base;
  Design bare;
  std::vector<std::string> warnings;
};

/// A warning: an effect whose coefficient came out beyond its physical bound.
std::string taken_out(const Effect& row);

/// Nonlinear parameters of the effects follow the rows. What is beyond its physical bound in these
/// is taken out, with a warning. Throws Error(not_identifiable) where the rows do not determine an
/// effect from the other columns.
KeptBase fit_kept_base(std::span<const Model> models, std::vector<Stretch> stretches,
                       const Smoothing& smoothing, const ScanSettings& settings);

}  // namespace cablefit
