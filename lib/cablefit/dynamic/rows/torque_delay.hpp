// Is the torque in the log the one that acts at that instant, or is it held until the next sample?
// The delay between the two is estimated, with an interval, and the nearer of the two conventions
// is taken.
#pragma once

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"

namespace cablefit {

/// Motor-side (or rigid) equation with tau(t - d) = tau - d dtau/dt. d is estimated by instrumental
/// variables: the derivative of the MODEL's torque is the instrument for that of the measured one,
/// whose noise would otherwise pull d towards 0. Uses the first windows of every log.
TorqueDelay estimate_torque_delay(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                  const RowSettings& settings, double rest_speed, Side side,
                                  const ElasticFit* elastic, const JointPlace& place = {});

}  // namespace cablefit
