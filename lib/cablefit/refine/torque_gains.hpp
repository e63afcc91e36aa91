// Joints whose torques do not agree, and the effect that describes it. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/refine/joint_scales.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// The models without torque_gain (drive) of joints without a load: only the other joints show it,
/// and the comparison finds it again.
std::vector<Model> without_shown_gains(std::span<const Model> given, const RefineLogs& logs);

struct ComparedTorques {
  std::vector<JointScale> scales;  ///< per joint
  /// Of all joints, one per preload: links, cables and masses in the torque of the joints that
  /// agree, every motor in that of its logs. Empty: all agree.
  std::vector<Model> agreed;
};

/// By base fits of every joint. `models`: of all joints, one per preload.
ComparedTorques compared_torques(const std::vector<Model>& models, const RefineLogs& logs,
                                 double significance);

/// Models of one joint to begin with. Links and cables are in the torque of this joint, and the
/// motors of the others have the remaining gain, so that all move as the robot does.
std::vector<Model> start_of(int joint, std::span<const Model> models,
                            const ComparedTorques& torques);

/// Adds torque_gain (drive) to the results of joints that are off, by their refined values. Where a
/// joint's own load shows a factor, the other joints decide whether the load or the torque is
/// wrong. Results are those of start_of()'s models.
void name_torque_gains(const RefineLogs& logs, double significance,
                       std::vector<RefineResult>& joints);

}  // namespace cablefit
