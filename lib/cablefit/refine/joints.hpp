// Several joints: each is refined by its own equations, with the measured motion of the others as
// given (model/one_joint.hpp). So an effect that is missing on one joint does not look like an
// effect on another. Internal to refine/.
#pragma once

#include <span>

#include "cablefit/refine/joint_run.hpp"

namespace cablefit {

/// Refines one joint after the other. The significance level of each joint is the given one over
/// their number (Bonferroni 1936). A joint that cannot be refined does not stop the others. An
/// error that is the same for all joints is thrown.
RefineResult refine_joints(std::span<const Model> given, const RefineLogs& logs,
                           const RefineOptions& options, const RefineOne& refine_one);

}  // namespace cablefit
