// Inertias where a log is sampled too slowly for the resonance.
#pragma once

#include <vector>

#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/equations/preload_jobs.hpp"
#include "cablefit/identify/identify.hpp"

namespace cablefit {

/// Motion above half of the sample rate appears in the log at lower frequencies, where its
/// accelerations are too small. On a simulated rig J_link is 3 % too large at 100 Hz, and 0.1 % at
/// 200 Hz and 1 kHz with the same cut-off of 10 Hz. The copy of add_method_floor() does not show
/// that, since it follows the measured motion. Where no free resonance lies below half of the rate,
/// the moving logs of the preload are fitted again with half the cut-off, and how far the inertias
/// (kg m^2; kg on linear axes) move is part of their sd and of their intervals; more than half an
/// sd is a warning too. `estimates`: one per parameter of the layout.
void widen_aliased_inertias(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                            const JointFit& fit, const JudgedPoint& judged,
                            std::vector<PreloadFacts>& facts, std::vector<Estimate>& estimates);

}  // namespace cablefit
