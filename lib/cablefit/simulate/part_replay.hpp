// Simulation of one part of a log beside its measurement, window by window of the log in constant
// memory. Internal to simulate/.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cablefit/samples/survey/windows.hpp"
#include "cablefit/simulate/experiment.hpp"
#include "cablefit/simulate/gap_scan.hpp"
#include "cablefit/simulate/moved_simulations.hpp"
#include "cablefit/simulate/start_state.hpp"

namespace cablefit {

/// Rows measured and simulated, rows x joints. A channel that the log lacks has no columns.
struct ReplayedRows {
  std::size_t start = 0;      ///< running number of the start from a measured state, from 1
  double t0 = 0, period = 0;  ///< s, of the first row
  Eigen::ArrayXXd q, theta;   ///< measured, rad
  Eigen::ArrayXXd tau;        ///< measured, N m
  SimulationResult simulated;
  SimulationBand band;  ///< of the simulated rows, when asked for
};
using RowSink = std::function<void(const ReplayedRows&)>;

/// Rows of a log's window that a start from the measured state may look at, on either side; one
/// more for the row that a block steps on to.
inline constexpr Eigen::Index kReplayHalo = kStartRows + 1;
/// The halo for a model: corrections of a recording (model/effects.hpp) need neighbours too.
Eigen::Index replay_halo(const Model& model);

class PartReplay {
 public:
  /// `log` and `part` must outlive it. `log_number`: see SimulationInput. A band is made by
  /// `band_threads`; 0: none.
  PartReplay(Experiment experiment, const LogSurvey& log, const PartSurvey& part,
             std::size_t log_number, int band_threads = 0);

  /// The next window of the part, which has replay_halo rows. Signals are compared as the model's
  /// refinements correct them. `sink`: takes the rows. After a divergence nothing is done.
  void add(const Window& window, const RowSink& sink);

  SimulatedPart result() const;

 private:
  /// A signal that is compared; its deflection when `is_deflection`.
  struct Signal {
    Channel channel = Channel::q;
    int joint = 0;
    bool is_deflection = false;
    double noise = 0;  ///< of the sensor, sd
    GapScan scan = {};
    BandScan band = {};

    Eigen::ArrayXd measured(const ReplayedRows& rows) const;
    Eigen::ArrayXd simulated(const ReplayedRows& rows) const;
    Eigen::ArrayXd half_width(const ReplayedRows& rows) const;
  };

  void choose_signals();
  void add_corrected(const Window& window, const RowSink& sink);
  SimulationInput input_rows(const Window& window, Eigen::Index begin, Eigen::Index n_rows) const;
  Eigen::ArrayXXd measured(const Window& window, Channel channel, Eigen::Index begin,
                           Eigen::Index n_rows) const;
  void start_anew(const Window& window, Eigen::Index row);
  void simulate_rows(const Window& window, Eigen::Index begin, Eigen::Index end,
                     const RowSink& sink);
  void diverge(const ReplayedRows& rows, Eigen::Index row);
  void compare(const ReplayedRows& rows);
  SignalGap gap_of(const Signal& signal) const;

  Experiment experiment_;
  const LogSurvey& log_;
  const PartSurvey& part_;
  std::size_t log_number_;
  Eigen::Index window_rows_;  ///< between starts from the measured state; 0: never
  std::optional<Simulation> simulation_;
  std::optional<MovedSimulations> moved_;  ///< for the band, when asked for
  std::vector<Signal> signals_;
  TensionScan tensions_;
  SimulatedPart result_;
};

}  // namespace cablefit
