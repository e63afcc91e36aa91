// A copy of an experiment: the same motion, sensors and clock as the logs have, with a model in
// place of the bench.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/base/random.hpp"
#include "cablefit/copies/coloured_noise.hpp"
#include "cablefit/samples/rows/row_stream.hpp"
#include "cablefit/samples/survey/recorded.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

/// Evenly spaced rows without a gap, of one part of one log.
struct CopyStretch {
  std::size_t log = 0, part = 0;
  double t0 = 0;             ///< s
  double period = 0;         ///< s, of the log's rows
  Eigen::MatrixXd measured;  ///< rows x slots of the log's plan
  /// Rows of `input` for each row of the log. More than one: the log's torque is a mean over its
  /// row, centred, of commands that change `fine` times as often.
  int fine = 1;
  double late = 0;        ///< s, `fine` > 1: the log's torque acts so much after its time stamp
  SimulationInput input;  ///< reference or command, load and initial state
  Rig rig;  ///< the log's, with the controller that is simulated; none: the torque is a command
  bool link_blocked = false;
  bool hold_torque = true;  ///< of a command
};

/// How a log's channels are measured: rounded to `quantum` after noise of `noise` was added.
struct CopySensor {
  double quantum = 0, noise = 0;
};

/// Disturbance torques, per joint; sd 0: none.
struct CopyDisturbance {
  std::vector<ArModel> motor, link;
};

struct SimulatedCopy {
  Model model;
  std::vector<LogPlan> plans;  ///< as those of the logs
  std::vector<std::vector<PartSurvey>> parts;
  std::vector<CopyStretch> stretches;
  std::vector<std::vector<CopySensor>> sensors;  ///< by log and slot
  std::vector<double> jitter;  ///< s, sd of the time error of a row, by log (clock_jitter.hpp)
  double step = SimulationOptions{}.step;  ///< s, at most
  std::vector<std::string> notes;          ///< what is simulated, in words
};

/// What decides about the controller of a copy.
struct CopyDrive {
  bool torque_held = true;
  double torque_period = 0;  ///< s, of a held torque; 0: the log's
  double cutoff = 0;     ///< Hz, of the low-pass on what a surrogate controller follows; 0: none
  bool follows = false;  ///< a surrogate controller, also where the rig's controller is known
  double step = SimulationOptions{}.step;  ///< s, at most, of the simulation
  /// Hz: up to here a surrogate controller's feed-forward holds what the measured torque does
  /// faster than `cutoff`, as far as the measured motion confirms that it acted (encoder steps
  /// through a controller do, noise of the torque sensor does not); 0: none of it.
  double dither_cutoff = 0;
};

/// The parts of the logs for which `wanted` says true, in closed loop: the rig's controller where
/// it and its reference are known, else a surrogate controller that follows the measured theta with
/// the measured torque as feed-forward. Blocked parts have their link held. Throws Error(input) for
/// a missing channel.
SimulatedCopy make_copy(const Model& model, std::span<const LogSurvey> logs,
                        const PartFilter& wanted, const CopyDrive& drive);

/// Stretches of the wanted parts of one log with what was measured, without a controller.
/// `number`: of the log.
std::vector<CopyStretch> read_stretches(const LogSurvey& log, std::size_t number,
                                        const PartFilter& wanted);

/// The true motion of every stretch on the rows of its log. Throws Error(not_identifiable) when it
/// diverges.
std::vector<SimulationResult> run_copy(const SimulatedCopy& copy,
                                       const CopyDisturbance& disturbance, Random& random,
                                       int threads = 1);

/// Motions as a recorder with the copy's sensors sees them.
std::vector<LogSurvey> record_copy(const SimulatedCopy& copy,
                                   const std::vector<SimulationResult>& motions, Random& random);

/// Fills `sensors` from the rig files, and where they say nothing so that the copy's logs look as
/// noisy as the measured ones, and `jitter`: `motions` are those without disturbances.
void choose_sensors(SimulatedCopy& copy, const std::vector<SimulationResult>& motions);

}  // namespace cablefit
