// Filter, decimation, edges and rest threshold. They are chosen from the log unless the user sets
// them, and always reported with the reason.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/plan/decision.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// Settings that the command line may fix; others are chosen.
struct SampleOptions {
  std::optional<double> cutoff;  ///< Hz; 0: no filter
  std::optional<int> filter_order;
  std::optional<int> decimate;
  std::optional<long> drop_edge;     ///< rows
  std::optional<double> rest_speed;  ///< rad/s; 0: keep all
  std::optional<TorqueHold> torque_hold;
  int threads = 1;
};

/// The same where a cut-off is given; else with the widest band that the differences allow at
/// `rate`, Hz.
SampleOptions with_wide_band(SampleOptions options, double rate);

struct ChosenSettings {
  RowSettings rows;
  double cutoff_q = 0;          ///< Hz, for equations with the second derivative of q; 0: no filter
  double rest_speed_theta = 0;  ///< rad/s, for equations of the motor (or rigid) side
  double rest_speed_q = 0;      ///< rad/s, for equations of the link side
  double resonance = 0;         ///< Hz, given resonance of the elastic drive; 0: none
  std::vector<Decision> decisions;
  std::vector<std::string> warnings;
};

/// Settings of the quasi-static stage 1: a low cut-off, rest dropped. `rest_speed_q` is the speed
/// below which a link counts as blocked: 5 % of its upper quartile, at least 4 sd of its noise.
/// `joint` (from 0): its sweep decides. Of the settings only the rest speeds depend on it.
ChosenSettings blocked_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                const SampleOptions& options, int joint = 0);

/// Settings of stage 2. `resonance`: f0 of the elastic fit in Hz, or 0 for a rigid drive. `joint`
/// (from 0): its motion decides.
ChosenSettings moving_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                               const SampleOptions& options, double resonance, int joint = 0);

}  // namespace cablefit
