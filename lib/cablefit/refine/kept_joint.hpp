// What is known of one of several joints that could not be refined. Internal to refine/.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

/// The models of one joint with the base fit that its training logs give, without sd: start values
/// of a search. Of blocked logs alone, and where there is none, as they are.
std::vector<Model> with_base_fit(const std::vector<Model>& models, const RefineLogs& logs);

struct KeptJoint {
  std::vector<Model> models;  ///< of this joint, one per preload
  std::string source;         ///< whose values these are, as the end of a sentence
};

/// The values of the `given` models with their sd; where these have none, those of the base fit;
/// where there is none either, no values. `started`: the models that the other joints begin with.
/// `joint`: from 0.
KeptJoint kept_joint(std::span<const Model> given, std::span<const Model> started, int joint,
                     const RefineLogs& logs);

}  // namespace cablefit
