// How one part of a log is simulated: closed loop or torque replay, by which rig, in which windows;
// every choice with its reason.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "cablefit/simulate/simulate_result.hpp"
#include "cablefit/simulate/simulator.hpp"

namespace cablefit {

/// Closed loop when there is a controller and its reference is in the log, else torque replay.
enum class ReplayMode { automatic, closed_loop, torque };

/// Torque replay of a noisy torque drifts: nothing pulls a joint back that friction alone holds. On
/// the paper's rig 0.3 N m at 1 kHz are 1.4 mrad after 1 s.
inline constexpr double kReplayWindowSeconds = 1.0;

struct ReplayOptions {
  ReplayMode mode = ReplayMode::automatic;
  std::optional<TorqueHold> torque_hold;  ///< the rig's when not given
  /// s; a simulation starts anew from the measured state this often. 0: never. Not given: never in
  /// closed loop, else kReplayWindowSeconds.
  std::optional<double> window;
  /// Share (0..1] of the time of every part, its end, that is compared; what comes before is only
  /// simulated.
  double compared = 1;
  /// s. Not given: that of SimulationOptions, of coupled links arm_step().
  std::optional<double> step;
  std::string trajectories;  ///< CSV file of every row; empty: none
  bool figures = false;      ///< for reports with plots
  bool band = false;         ///< also the 95 % band of the parameters' covariance
  int threads = 1;
};

/// The rig of a log as the simulation of `model` wants it: --rig, else the one beside the log, else
/// the model's; what a log's rig file leaves open (load, controller, sensors, torque hold) is the
/// model's. Throws Error(input) when it is a bench of another kind.
Rig rig_for_simulation(const std::string& log_path, const std::string& rig_option,
                       const Model& model);

/// Surveys a log with that rig. Parts without a preload of their own get the rig's, else the
/// model's.
LogSurvey survey_for_simulation(const std::string& log_path, const std::string& rig_option,
                                const Model& model, const Reading& reading = {});

/// Why a log cannot be simulated in closed loop, so that its torque is replayed; empty: it can.
std::string no_closed_loop(const LogPlan& plan);

/// Of the model's preload; of any, where the model names none.
bool is_of_model(const Model& model, const PartSurvey& part);

struct Experiment {
  Model model;  ///< with the log's rig
  SimulationOptions simulation;
  double window_seconds = 0;                                        ///< 0: the whole stretch
  double compared_from = -std::numeric_limits<double>::infinity();  ///< s, time of the log
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
};

/// Throws Error(input) for a channel that is missing.
Experiment plan_experiment(const Model& model, const LogSurvey& log, const PartSurvey& part,
                           const ReplayOptions& options);

}  // namespace cablefit
