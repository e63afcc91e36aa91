// Evenly sampled recordings out of logs: what refine looks at, again and again. Internal to
// refine/.
#pragma once

#include <span>
#include <vector>

#include "cablefit/model/effects.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {

/// Evenly spaced rows without a gap, of one part of one log.
struct Stretch {
  std::size_t log = 0;                  ///< among those given
  std::size_t model = 0;                ///< which of the models its preload is
  double t0 = 0;                        ///< s, since the log began
  double part_begin = 0, part_end = 0;  ///< s, since the log began: of its part
  bool blocked = false;
  Eigen::Index rows_from = 0;  ///< samples before this are history, and give no rows
  Recording recording;         ///< tau_load complete: what the rig's law says is in it
};

/// The wanted parts of the logs, whose preloads are those of `models` (one per preload; a single
/// one takes every preload). Of one joint: that of the models, see one_joint.hpp. Throws
/// Error(input) for a missing channel.
std::vector<Stretch> read_stretches(std::span<const LogSurvey> logs, std::span<const Model> models,
                                    const PartFilter& wanted);

/// Whether all rows come from blocked links.
bool is_blocked_only(std::span<const Stretch> stretches);

/// s, of the stretches that `blocked` says; infinite where there are none.
double finest_period(std::span<const Stretch> stretches, bool blocked);

enum class HoldOut { moving, all };

/// The last `share` (0..1) of the time of every part (of the recorded time where it is mostly
/// gaps), taken from its stretches (`which`: those of moving parts alone, or all); with what came
/// before in the stretch as history for effects that remember it.
std::vector<Stretch> hold_out(std::vector<Stretch>& stretches, double share, HoldOut which);

}  // namespace cablefit
