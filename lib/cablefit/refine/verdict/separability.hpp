// Effects that these logs could separate at all, from the equations' columns alone, before the
// residual is used. The test: an effect of a size that matters is fitted by the model's own
// parameters or by another effect, and the residual must be larger than noise. Internal to refine/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/evidence.hpp"
#include "cablefit/refine/search/trial_run.hpp"

namespace cablefit {

/// Groups of effects that are not separable, and for each the cheapest run (of trial_runs) that
/// would separate them. `x`: values of the design's columns. `floor`: per kind of row.
std::vector<NotSeparable> find_not_separable(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor,
                                             const std::vector<TrialRun>& runs, int threads = 1);

}  // namespace cablefit
