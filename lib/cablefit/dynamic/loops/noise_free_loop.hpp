// The noise-free motion of a fitted model, in its loop or by a commanded torque: what the robot
// would have done without disturbances and encoder noise. Instruments are made of it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/dynamic/loops/controller_fit.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Where the reference of the loop comes from.
enum class LoopKind {
  known,      ///< a controller follows the log's reference: the rig's, or one found from the logs
  command,    ///< the rig says that the torque is a command: it is replayed, there is no loop
  surrogate,  ///< a stiff PD controller follows the measured theta, smoothed
  none        ///< nothing can be simulated
};

struct LoopPlan {
  LoopKind kind = LoopKind::none;
  std::string reason;    ///< why not the known one, or why none
  double bandwidth = 0;  ///< Hz, of the smoothed theta
  /// Of a known loop: found from the logs, where the rig file has none that made their torque.
  std::optional<ControllerFit> fitted = {};
  std::vector<std::string> warnings = {};
};

/// Instruments of this loop keep out disturbances that moved the robot, not encoder noise alone.
inline bool keeps_disturbances_out(LoopKind kind) {
  return kind == LoopKind::known || kind == LoopKind::command;
}

/// One for all wanted logs of the job: known, or command, when every one of them allows it. A
/// controller of the rig file that does not make the logs' torque is not used, with a warning; one
/// that does is looked for then, and where there is none.
LoopPlan plan_loop(const DynamicJob& job, std::span<const LogSurvey> logs);

/// Where instruments come from and what they keep out, in words. Not of a plan for none.
std::string source_of_instruments(const LoopPlan& plan);

struct SimulatedLogs {
  std::vector<LogSurvey> logs;  ///< the wanted parts with q and theta of the loop, see LogCopy
  std::string failure;          ///< where it diverged; empty: it did not
};

/// Logs side by side on the job's threads, each in order and in constant memory: the same bits for
/// any number of them. The step is coarse (kLoopStep): an instrument need not be exact, only free
/// of noise, and 0.07 % of phase at 100 Hz costs nothing; where that diverges, the simulator's own.
SimulatedLogs simulate_loops(const DynamicJob& job, std::span<const LogSurvey> logs,
                             const Model& model, const LoopPlan& plan);

}  // namespace cablefit
