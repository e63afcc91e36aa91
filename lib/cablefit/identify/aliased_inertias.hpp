// Inertias where the log is too slow for the resonance.
#pragma once

#include <vector>

#include "cablefit/identify/elongations/judged_point.hpp"
#include "cablefit/identify/equations/preload_jobs.hpp"
#include "cablefit/identify/identify.hpp"

namespace cablefit {

/// A free resonance above half of the sample rate appears in the log at a lower frequency, where
/// its accelerations are too small, and an inertia comes out too large. The simulated copy of
/// add_method_floor() does not show all of that: disturbances that excite the resonance are not
/// known to it. Where a preload is sampled so slowly, its moving logs are fitted again with half
/// the cut-off, which keeps the false frequency out; how far the inertias move is part of their sd
/// and a warning. `estimates`: one per parameter of the layout.
void widen_aliased_inertias(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                            const JointFit& fit, const JudgedPoint& judged,
                            std::vector<PreloadFacts>& facts, std::vector<Estimate>& estimates);

}  // namespace cablefit
