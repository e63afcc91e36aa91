// Which equations of which logs of a preload are fitted, read with which settings.
#pragma once

#include "cablefit/identify/preload_jobs.hpp"

namespace cablefit {

/// The equation of the blocked link. `moving`: the motor equation is there too and tells the
/// frictions.
JointRecord blocked_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                           bool moving, PreloadFacts& facts);

/// Link and motor equation with settings that need no elastic fit yet.
JointRecord first_moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                const PreloadFacts& facts);

/// The same with settings chosen by the elastic fit: filter by the resonance, torque hold.
JointRecord moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                          const Transmission& fitted, const DeflectionRange& deflections,
                          PreloadFacts& facts);

}  // namespace cablefit
