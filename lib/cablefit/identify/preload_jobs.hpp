// From logs to the jobs of the one-step identification: which equations of which logs, read with
// which settings, and which l_o are looked for.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/identify/joint_equations.hpp"

namespace cablefit {

/// What is found out about a preload besides its job.
struct PreloadFacts {
  std::string name;
  Rig rig;
  bool has_blocked = false, has_moving = false;
  TorqueDelay delay;
  double resonance = 0, load_inertia = 0;
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
};

/// A job per preload without records: cables, and what is searched. Fills `decisions` of the
/// result. Throws Error(input) when the rigs do not go together.
std::vector<PreloadJob> begin_jobs(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                   std::vector<PreloadFacts>& facts, IdentifyResult& result);

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
