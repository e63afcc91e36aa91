// Running statistics of the clock of one part: period, jitter, gaps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace cablefit {

/// The time between rows of one part.
struct ClockSurvey {
  std::size_t n_rows = 0;
  std::size_t n_gaps = 0;  ///< jumps in time; nothing is differenced across them
  double t_first = 0, t_last = 0;
  double period = 0;        ///< s, mean time between rows outside gaps
  double jitter = 0;        ///< sd of the time between rows / period
  double worst_jitter = 0;  ///< largest deviation from the period / period
  bool uneven = false;      ///< has to be resampled to an even grid
};

/// Longest step, in periods, that is still no gap.
double gap_factor(bool uneven);

/// Steps of time up to a longest one, beyond which they are gaps.
struct StepSums {
  double longest = 0, sum = 0, squares = 0, low = 0, high = 0;
  std::size_t n = 0, n_gaps = 0;
  void add(double step);
};

/// Whether a step is a gap depends on whether the clock is even, which shows only at the end, so
/// both ways of counting are kept. The scale is the median of the first steps.
class ClockScan {
 public:
  /// Whether the time has jumped since the row before: differences must not reach across.
  /// `continues`: the row before belongs to the same part. Throws Error(input) at the line for time
  /// that does not advance.
  bool add(double t, bool continues, const std::string& path, std::uint64_t line);
  /// add() for as many of the times as follow on the row before without a jump, an error or an
  /// uncalibrated step: all of an ordinary log but its first rows. Returns how many.
  std::size_t add_usual(std::span<const double> t);
  ClockSurvey result();

 private:
  void add_step(double step);
  void calibrate();
  void count(double step);

  std::array<double, 64> early_{};
  StepSums even_, uneven_;
  double first_ = 0, last_ = 0, last_step_ = 0, median_ = 0;
  std::size_t n_rows_ = 0, n_steps_ = 0, n_off_ = 0;
};

}  // namespace cablefit
