// Friction, efficiency and stiffness against the preload, between the fitted ones. Internal to
// design/.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "cablefit/model/principal_copies.hpp"

namespace cablefit {

/// Adds the figures of every joint, with 95 % bands, and the fitted preloads as points. Nothing
/// without two fitted preloads.
void add_preload_figures(const Model& model, const std::vector<MovedModel>& copies,
                         const DesignOptions& options, DesignResult& result);

}  // namespace cablefit
