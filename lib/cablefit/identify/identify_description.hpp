// From the judged solution to the result that reports show.
#pragma once

#include "cablefit/identify/identify.hpp"
#include "cablefit/identify/identify_estimates.hpp"
#include "cablefit/identify/preload_jobs.hpp"

namespace cablefit {

/// Fills parameters, preloads, slack points, models and warnings. `estimates`: of the layout.
void describe(const JointFit& fit, const JudgedPoint& judged,
              const std::vector<Estimate>& estimates, const std::vector<PreloadFacts>& facts,
              const IdentifyOptions& options, IdentifyResult& result);

}  // namespace cablefit
