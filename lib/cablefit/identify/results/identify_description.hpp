// From the judged solution to the result that reports show.
#pragma once

#include "cablefit/identify/equations/preload_jobs.hpp"
#include "cablefit/identify/identify_options.hpp"
#include "cablefit/identify/identify_result.hpp"
#include "cablefit/identify/results/identify_estimates.hpp"

namespace cablefit {

/// Fills parameters, preloads, slack points, models and warnings. `estimates`: of the layout.
void describe(const JointFit& fit, const JudgedPoint& judged,
              const std::vector<Estimate>& estimates, const std::vector<PreloadFacts>& facts,
              const IdentifyOptions& options, IdentifyResult& result);

}  // namespace cablefit
