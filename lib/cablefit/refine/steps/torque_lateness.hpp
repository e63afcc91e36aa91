// How late the logged torque acts, by the model and its own rows. Internal to refine/.
#pragma once

#include <optional>
#include <span>

#include "cablefit/model/model.hpp"
#include "cablefit/samples/rows/torque_hold.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// The lateness of the torque, fitted together with all that is linear in the models (one per
/// preload, of one joint). `row`: s, of the moving logs. Nothing where the logs do not determine
/// them.
std::optional<TorqueLateness> fit_torque_lateness(std::span<const Model> models,
                                                  std::span<const LogSurvey> logs, double row);

}  // namespace cablefit
