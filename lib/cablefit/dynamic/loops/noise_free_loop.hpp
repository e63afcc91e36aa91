// The noise-free motion of a fitted model, in closed loop or with the commanded torque: the motion
// of the robot without disturbances and encoder noise. It gives the instruments.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/dynamic/loops/controller_fit.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// Source of the loop's reference.
enum class LoopKind {
  known,  ///< a controller, the rig's or one identified from the logs, follows the log's reference
  command,    ///< the rig says that the torque is a command: it is replayed without a loop
  surrogate,  ///< a stiff PD controller follows the measured theta, smoothed
  none        ///< no simulation is possible
};

struct LoopPlan {
  LoopKind kind = LoopKind::none;
  std::string reason;    ///< why it is not the known loop, or why there is none
  double bandwidth = 0;  ///< Hz, of the smoothed theta that a surrogate follows
  /// The controller identified from the logs, for a known loop where the rig file has none that
  /// explains their torque.
  std::optional<ControllerFits> fitted = {};
  std::vector<std::string> warnings = {};
};

/// Whether instruments of this loop exclude disturbances that moved the robot, and not only encoder
/// noise.
inline bool keeps_disturbances_out(LoopKind kind) {
  return kind == LoopKind::known || kind == LoopKind::command;
}

/// One plan for all wanted logs of the job: known or command, when every log allows it. A
/// controller of the rig file that does not explain the logs' torque is not used, with a warning.
/// Then, and where the rig file has none, a controller is identified from the logs.
LoopPlan plan_loop(const DynamicJob& job, std::span<const LogSurvey> logs);

/// The surrogate instead of a controller that was found from the logs. Where a log has fewer
/// samples than the controller had periods, the law fits, but may be unstable at that period.
LoopPlan without_found_controller(LoopPlan plan);

/// The source of the instruments and the disturbances that they exclude, in words. Not for a plan
/// without a loop.
std::string source_of_instruments(const LoopPlan& plan);

struct SimulatedLogs {
  std::vector<LogSurvey> logs;  ///< the wanted parts, with q and theta of the loop (LogCopy)
  std::string failure;          ///< where the simulation diverged; empty: it did not
};

/// Simulates the logs on the job's threads, each in order and in constant memory, with the same
/// bits for any number of threads. The step is coarse (kLoopStep): an instrument must be free of
/// noise but need not be exact, and 0.07 % of phase at 100 Hz is negligible. Where that diverges,
/// the simulator's own step is used.
SimulatedLogs simulate_loops(const DynamicJob& job, std::span<const LogSurvey> logs,
                             const Model& model, const LoopPlan& plan);

}  // namespace cablefit
