// White noise of position sensors, and what is left of it in speeds and accelerations.
#pragma once

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// sd of the white noise on a position channel (rad): the rig's quantum / sqrt(12) when given, else
/// the larger of what sixth differences show and the log's own quantum / sqrt(12).
double position_noise(const LogSurvey& log, const PartSurvey& part, Channel channel, int joint = 0);

/// sd of velocity and acceleration that white position noise leaves below a cut-off (one-sided band
/// 0..cutoff of rate/2).
double velocity_noise(double position_noise, double cutoff, double rate);
double acceleration_noise(double position_noise, double cutoff, double rate);

}  // namespace cablefit
