// From logs to the jobs of the one-step identification: which preloads there are, their cables, and
// which l_o are looked for.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/identify/equations/joint_equations.hpp"
#include "cablefit/identify/identify_options.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// What is found out about a preload besides its job.
struct PreloadFacts {
  std::string name;
  Rig rig;
  const Arm* arm = nullptr;  ///< of the logs' rig; nullptr: the links do not move each other
  bool has_blocked = false, has_moving = false;
  TorqueDelay delay;
  double resonance = 0, load_inertia = 0;  ///< f0, the highest of all joints
  double rate = 0;                         ///< Hz, of the slowest moving log
  /// Hz, of the moving logs, per joint: f0 (0: not known) and cut-off.
  std::vector<double> resonances, cutoffs;
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  /// Effects beyond (31), with the values about which the columns are made, and the cables that
  /// they go by: as far as they are known.
  EffectsPerJoint added = {};
  std::shared_ptr<const Transmission> cables = {};
};

/// Of every preload wanted, in the order in which they come. Throws Error(input) when logs of one
/// preload have different rigs.
std::vector<PreloadFacts> preloads_of(std::span<const LogSurvey> logs,
                                      const IdentifyOptions& options);

/// A job per preload without records: cables, and what is searched. Fills `decisions` of the
/// result. Throws Error(input) when the rigs do not go together.
std::vector<PreloadJob> begin_jobs(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                   std::vector<PreloadFacts>& facts, IdentifyResult& result);

}  // namespace cablefit
