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

struct SplitLateness {
  TorqueLateness moving, blocked;
};

/// The same with one lateness for the moving logs and one for the blocked logs. `row`,
/// `blocked_row`: s, of either.
std::optional<SplitLateness> fit_split_lateness(std::span<const Model> models,
                                                std::span<const LogSurvey> logs, double row,
                                                double blocked_row);

}  // namespace cablefit
