// A design's fit as effects with numbers and as models. Internal to refine/.
#pragma once

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/final_fit.hpp"

namespace cablefit {

/// The added effects, in order, with values, sd and 95 % intervals (t quantile of the blocks).
std::vector<NamedEffect> named_effects(const Design& design, const FinalFit& fit);

/// Parameters of the base that both designs have, including those of its kept effects: before
/// (values of `first`) and after.
std::vector<ParameterShift> parameter_shifts(const Design& first, const Eigen::VectorXd& before,
                                             const Design& design, const FinalFit& fit);

/// The design's models with these values and the added effects, as they are from now on: lasting
/// events have happened, passing ones are over. No sd.
std::vector<Model> models_with(const Design& design, const Eigen::VectorXd& x);
/// The same with the sd of every parameter.
std::vector<Model> refined_models(const Design& design, const FinalFit& fit);

}  // namespace cablefit
