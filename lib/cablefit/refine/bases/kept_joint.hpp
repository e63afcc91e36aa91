// Known values of one of several joints that could not be refined. Internal to refine/.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

/// Of models of one joint. Nothing: there are blocked logs alone, or the logs do not determine it.
std::optional<BaseFit> base_fit_of(const std::vector<Model>& models, const RefineLogs& logs);

/// Of each joint of the models, without states, which are most of its memory.
std::vector<std::optional<BaseFit>> base_fits_of(const std::vector<Model>& models,
                                                 const RefineLogs& logs);

/// The models of one joint with the values of the base fit to its training logs, without sd: start
/// values of a search. Unchanged for blocked logs alone, and where there is no base fit.
std::vector<Model> with_base_fit(const std::vector<Model>& models, const RefineLogs& logs);

/// The base fit with the sd of its values. Nothing: there is none.
std::optional<std::vector<Model>> base_estimates(const std::vector<Model>& models,
                                                 const RefineLogs& logs);

struct KeptJoint {
  std::vector<Model> models;  ///< of this joint, one per preload
  std::string source;         ///< source of the values, as the end of a sentence
};

/// The values of the `given` models with their sd. Where these have none, those of the base fit.
/// Where that has none either, no values. `started`: the models that the other joints start from.
/// `joint`: from 0.
KeptJoint kept_joint(std::span<const Model> given, std::span<const Model> started, int joint,
                     const RefineLogs& logs);

}  // namespace cablefit
