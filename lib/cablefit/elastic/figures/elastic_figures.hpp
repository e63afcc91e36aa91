// Stage 1 as the paper draws it (Figs. 6 and 7): torque and elastic error against deflection, and
// the residuals from all sides.
#pragma once

#include <vector>

#include "cablefit/elastic/figures/cable_figure.hpp"
#include "cablefit/elastic/models/candidates.hpp"
#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Streams the rows once more. `joint`: whose rows they are, from 0. candidates[k], solutions[k]
/// belong to preload.fits[k]. `compared`: drawn beside the cables of one joint.
std::vector<Figure> elastic_figures(const ElasticJob& job, const BlockedRows& rows, int joint,
                                    const std::vector<ElasticCandidate>& candidates,
                                    const std::vector<LinearSolution>& solutions,
                                    const ElasticPreload& preload,
                                    const std::vector<ComparedModel>& compared);

}  // namespace cablefit
