// The first windows of the logs: enough to choose settings by, and quick.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

/// Up to the first `max_windows` wanted windows of every log, for choosing and for small tests.
struct PreliminaryWindow {
  std::size_t log = 0;
  Window window;
};
std::vector<PreliminaryWindow> preliminary_windows(std::span<const LogSurvey> logs,
                                                   const PartFilter& wanted,
                                                   const SignalSettings& settings,
                                                   Eigen::Index halo, int max_windows);

/// Windows that settings are chosen by.
inline constexpr int kSettingsWindows = 4;

/// Accelerations over the first windows, by cut-off.
class PreliminaryMotion {
 public:
  /// Both must outlive this. `joint`: whose motion, from 0.
  PreliminaryMotion(std::span<const LogSurvey> logs, const PartFilter& wanted, int joint = 0);

  int joint() const { return static_cast<int>(joint_); }
  /// Root mean square of qdd or thetadd, rad/s^2; 0 when the logs do not have it.
  double acceleration(const SignalSettings& settings, Channel channel);

 private:
  struct MeanSquare {
    double sum = 0;
    Eigen::Index n = 0;
    void add(const Eigen::ArrayXd& a, const Window& window);
    double root() const;
  };
  struct Accelerations {
    MeanSquare q, theta;
  };
  Accelerations measure(const SignalSettings& settings) const;

  std::span<const LogSurvey> logs_;
  const PartFilter& wanted_;
  std::size_t joint_;
  double rate_;
  std::map<double, Accelerations> known_;
};

}  // namespace cablefit
