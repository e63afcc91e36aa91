// Models that `design` starts from.
#pragma once

#include <string>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// A model to design with: a model file or a result, as read_model() takes it, or a rig file
/// (cablefit/rig/1) whose cables have "coefficients"; then the joints have no inertias. Throws
/// Error(input) for anything without cables.
Model read_design_model(const std::string& path, const std::string& preload,
                        const std::string& model, std::string& choice);

/// Every preload of these results or model files, of the fit `model` (empty: "poly"); numbers that
/// a fit did not determine are NaN. Throws Error(input) for anything without cables.
std::vector<Model> read_fitted_models(const std::vector<std::string>& paths,
                                      const std::string& model);

/// Fits of several preloads, and which preloads have none that serves.
struct FittedPreloads {
  std::vector<Model> models;
  std::vector<std::string> left_out;  ///< "high: " and the reason
};
/// The preloads of a result of stage 2 or of one step, of the fit `model` (empty: "poly"); nothing
/// of other files, which know one preload or no friction.
FittedPreloads other_preloads(const std::string& path, const std::string& model);

/// Throws Error(input) for a rigid drive and for a spring.
void require_cables(const Model& model, const std::string& path);

}  // namespace cablefit
