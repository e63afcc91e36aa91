// Which effects these logs could separate at all, from the equations' columns alone, before the
// residual is looked at: an effect of a size that matters, fitted by the model's own parameters or
// by another effect, must leave more than noise does. Internal to refine/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/evidence.hpp"
#include "cablefit/refine/search/trial_run.hpp"

namespace cablefit {

/// Groups that are not separable, and for each the cheapest run (of trial_runs) that would.
/// `x`: values of the design's columns. `floor`: per kind of row.
std::vector<NotSeparable> find_not_separable(const Design& design, const Eigen::VectorXd& x,
                                             const KindLevels& floor,
                                             const std::vector<TrialRun>& runs, int threads = 1);

}  // namespace cablefit
