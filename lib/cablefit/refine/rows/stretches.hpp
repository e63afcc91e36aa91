// Evenly sampled recordings from logs, which refine reads many times. Internal to refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// Evenly spaced rows without a gap, of one part of one log.
struct Stretch {
  std::size_t log = 0;                  ///< number among the given logs
  std::size_t model = 0;                ///< number of the model of its preload
  double t0 = 0;                        ///< s, since the log began
  double part_begin = 0, part_end = 0;  ///< s, since the log began, of its part
  bool blocked = false;
  Eigen::Index rows_from = 0;  ///< samples before this are history and have no rows
  Recording recording;         ///< tau_load is complete: it includes the torque of the rig's law
};

/// The wanted parts of the logs. Their preloads must be those of `models` (one per preload; a
/// single model takes every preload). For one joint of several: the joint of the models, see
/// one_joint.hpp. Throws Error(input) for a missing channel.
std::vector<Stretch> read_stretches(std::span<const LogSurvey> logs, std::span<const Model> models,
                                    const PartFilter& wanted);

/// Whether all rows come from blocked links.
bool is_blocked_only(std::span<const Stretch> stretches);

/// s, of the blocked or the other stretches; infinite where there are none.
double finest_period(std::span<const Stretch> stretches, bool blocked);

enum class HoldOut { moving, all };

/// Removes the last `share` (0..1) of the time of every part from its stretches and returns it (of
/// the recorded time where the part has mostly gaps). `which`: moving parts only, or all. Earlier
/// samples of the stretch stay as history for effects with memory.
std::vector<Stretch> hold_out(std::vector<Stretch>& stretches, double share, HoldOut which);

}  // namespace cablefit
