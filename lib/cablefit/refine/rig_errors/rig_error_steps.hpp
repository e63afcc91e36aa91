// Results of refine where values of the rig file may be wrong. Internal to refine/.
#pragma once

#include "cablefit/refine/joint_run.hpp"

namespace cablefit {

/// Refines every joint; again with the right values where up to three of the rig file are wrong and
/// that explains what the joints show.
JointRun without_rig_errors(std::span<const Model> models, const RefineLogs& logs,
                            const RefineOptions& options, const RefineOne& refine_one);

}  // namespace cablefit
