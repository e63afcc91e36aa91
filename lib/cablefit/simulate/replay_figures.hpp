// A simulation beside its measurement, and the gap between the two over time.
#pragma once

#include <string>
#include <vector>

#include "cablefit/figure/explained.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/samples/rows/time_axis.hpp"
#include "cablefit/simulate/part_replay.hpp"

namespace cablefit {

class ReplayFigures {
 public:
  /// `closed_loop`: torques are compared as well, they are an input otherwise.
  ReplayFigures(const LogSurvey& log, const PartSurvey& part, bool closed_loop);

  void add(const ReplayedRows& rows);

  /// Per signal and joint: measured and simulated, then simulated minus measured.
  std::vector<Figure> figures() const;

 private:
  /// A signal of one joint; the deflection is theta - q.
  struct Signal {
    std::string name, kind, unit;
    Eigen::ArrayXXd ReplayedRows::*measured;
    Eigen::ArrayXXd SimulationResult::*simulated;
    Eigen::Index joint;
    Eigen::ArrayXXd SimulationBand::*band;
    ThinnedLine measured_line, simulated_line, gap_line;
    ThinnedLine near_measured, near_simulated;
    ThinnedLine band_above, band_below;
    Explained explained = {};
  };
  void add_signal(const LogSurvey& log, Channel channel, int joint);
  Figure blank(const Signal& signal) const;
  void add_band(const ReplayedRows& rows, Signal& signal) const;

  TimeAxis time_;
  std::string section_, group_;
  std::vector<Signal> signals_;
  bool has_band_ = false;
};

}  // namespace cablefit
