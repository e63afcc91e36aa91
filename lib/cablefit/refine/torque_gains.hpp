// Joints whose torques do not agree, and the effect that says so. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/refine/joint_scales.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

struct ComparedTorques {
  std::vector<JointScale> scales;  ///< per joint
  /// In the torque of the joints that agree, one per preload; empty: all agree.
  std::vector<Model> agreed;
};

/// By base fits of every joint. `models`: of all joints, one per preload.
ComparedTorques compared_torques(const std::vector<Model>& models, const RefineLogs& logs,
                                 double significance);

/// Models of one joint to begin with: all joints in the torque of this one, so that simulations
/// move as the robot does.
std::vector<Model> start_of(int joint, std::span<const Model> models,
                            const ComparedTorques& torques);

/// Adds torque_gain (drive) to the results of joints that are off, by the values that the joints
/// have in the end. Their models had all in their logged torque; then only the motor has.
void name_torque_gains(const ComparedTorques& torques, const RefineLogs& logs, double significance,
                       std::vector<RefineResult>& joints);

}  // namespace cablefit
