// A copy of an experiment: the motion, sensors and clock of the logs, with a model instead of the
// bench.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/base/random.hpp"
#include "cablefit/copies/coloured_noise.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"
#include "cablefit/samples/survey/recorded.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

/// Evenly spaced rows without a gap, of one part of one log.
struct CopyStretch {
  std::size_t log = 0, part = 0;
  double t0 = 0;             ///< s
  double period = 0;         ///< s, of the log's rows
  Eigen::MatrixXd measured;  ///< rows x slots of the log's plan
  /// Rows of `input` for each row of the log. More than one: the commands change `fine` times as
  /// often as the log has rows, and the log's torque is their centred mean over its row.
  int fine = 1;
  double late = 0;        ///< s, with `fine` > 1: delay of the log's torque after its time stamp
  SimulationInput input;  ///< reference or command, load and initial state
  Rig rig;                ///< the log's, with the simulated controller; none: tau is a command
  bool link_blocked = false;
  bool hold_torque = true;  ///< of a command
};

/// How a log's channels are measured: noise of sd `noise` is added (negative: with the opposite
/// sign), then values are rounded to `quantum`.
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
  double step = SimulationOptions{}.step;  ///< s, upper limit
  std::vector<std::string> notes;          ///< what the copy simulates, in words
};

/// The data that decide on the controller of a copy.
struct CopyDrive {
  bool torque_held = true;
  double torque_period = 0;  ///< s, of a held torque; 0: the log's
  double cutoff = 0;  ///< Hz, low-pass on the signals that a surrogate controller follows; 0: none
  bool follows = false;  ///< use a surrogate controller, even where the rig's controller is known
  double step = SimulationOptions{}.step;  ///< s, upper limit, of the simulation
  /// Hz. Between `cutoff` and this frequency, the feed-forward of a surrogate controller contains
  /// the measured torque as far as the measured motion confirms that it acted. Encoder steps that
  /// pass a controller act; noise of the torque sensor does not. 0: no such part.
  double dither_cutoff = 0;
};

/// Copies the parts of the logs for which `wanted` is true, in closed loop. The controller is the
/// rig's where it and its reference are known. Otherwise a surrogate controller follows the
/// measured theta, with the measured torque as feed-forward. Blocked parts have a blocked link.
/// Throws Error(input) for a missing channel.
SimulatedCopy make_copy(const Model& model, std::span<const LogSurvey> logs,
                        const PartFilter& wanted, const CopyDrive& drive);

/// Stretches of the wanted parts of one log with the measured signals, without a controller.
/// `number`: of the log.
std::vector<CopyStretch> read_stretches(const LogSurvey& log, std::size_t number,
                                        const PartFilter& wanted);

/// The true motion of every stretch on the rows of its log. Throws Error(not_identifiable) when it
/// diverges.
std::vector<SimulationResult> run_copy(const SimulatedCopy& copy,
                                       const CopyDisturbance& disturbance, Random& random,
                                       int threads = 1);

/// Logs of these motions, as recorded with the copy's sensors.
std::vector<LogSurvey> record_copy(const SimulatedCopy& copy,
                                   const std::vector<SimulationResult>& motions, Random& random);

/// Fills `sensors` from the rig files. Where these give none, the copy's logs get the noise of the
/// measured ones. Also fills `jitter`. `motions`: those without disturbances.
void choose_sensors(SimulatedCopy& copy, const std::vector<SimulationResult>& motions);

}  // namespace cablefit
