// What `cablefit simulate` found, as plain data for reports.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/plan/input_file.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

inline constexpr double kNormal975 = 1.959964;  ///< quantile, for 95 % bands

/// Uncertainty of a simulated signal from the joint covariance of the parameters.
struct SignalBand {
  double half_width = 0;  ///< of the 95 % band, rms over the rows, without sensor noise
  double inside = 0;      ///< share of the rows (0..1) with a gap inside band and noise together
};

/// Simulated minus measured over all simulated rows of a part. SI.
struct SignalGap {
  std::string signal;  ///< "q", "theta", "deflection" (theta - q), "tau"; "q2" with several joints
  std::string unit;
  double rms = 0, max_abs = 0;
  double t_of_max = 0;  ///< s
  double relative = 0;  ///< rms / rms of the measured signal about its mean; that 0: inf or NaN
  double noise = 0;     ///< sd of the sensor's noise or rounding: a perfect model leaves this rms
  double worst_window_rms = 0;
  double t_of_worst_window = 0;         ///< s, its first row
  std::optional<SignalBand> band = {};  ///< when asked for, of a model that knows its covariance
};

/// How one cable was pulled in the simulation.
struct CableTension {
  std::string cable, unit;
  double min = 0, max = 0;
  double slack_share = 0;  ///< of the rows, 0..1: tension exactly 0
};

/// One part (preload, phase, run) of one log.
struct SimulatedPart {
  std::string log, preload, phase, run;
  bool closed_loop = false;   ///< else the torque of the log was replayed
  bool held_torque = false;   ///< torque replay only
  double window_seconds = 0;  ///< restarted from the measured state this often; 0: never
  std::size_t n_windows = 0;  ///< starts from a measured state
  std::size_t n_rows = 0;     ///< simulated
  WindowCounts counts;
  std::vector<SignalGap> gaps;
  std::vector<CableTension> cables;     ///< empty for the linear model and rigid drives
  std::optional<double> closure_share;  ///< of the rows: all cables taut (force closure)
  std::string diverged;                 ///< where and when; empty: it did not
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
  std::vector<Figure> figures;

  std::string_view mode() const { return closed_loop ? "closed loop" : "torque replay"; }
};

struct SimulateResult {
  std::vector<InputFile> inputs;  ///< the logs; the command puts the model before them
  std::string model_path, model_choice, model_name, preload;
  std::string rig_path;  ///< the model's; empty: the default rig
  Axes axes = Axes::rotary;
  std::vector<SimulatedPart> parts;
  std::string trajectories;  ///< file, empty: none
  std::vector<std::string> warnings;
};

}  // namespace cablefit
