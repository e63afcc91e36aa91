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
  std::size_t n_gaps = 0;  ///< jumps in time; no differences are taken across them
  double t_first = 0, t_last = 0;
  double period = 0;        ///< s, mean time between rows outside gaps
  double jitter = 0;        ///< sd of the time between rows / period
  double worst_jitter = 0;  ///< largest deviation from the period / period
  bool uneven = false;      ///< must be resampled to an even grid
};

/// Longest time step, in periods, that does not count as a gap.
double gap_factor(bool uneven);

/// Sums over time steps up to `longest`; longer steps are gaps.
struct StepSums {
  double longest = 0, sum = 0, squares = 0, low = 0, high = 0;
  std::size_t n = 0, n_gaps = 0;
  void add(double step);
  void add(const StepSums& others);  ///< all but the count of gaps
};

/// Whether a step is a gap depends on whether the clock is even. That is known only at the end, so
/// both counts are kept. The scale is the
/// median of the first steps.
class ClockScan {
 public:
  /// Whether the time jumped since the last row: differences must not be taken across a jump.
  /// `continues`: the last row belongs to the same part. Throws Error(input) at the line where time
  /// does not advance.
  bool add(double t, bool continues, const std::string& path, std::uint64_t line);
  /// Adds leading times of `t` as long as none is a jump, an error or an uncalibrated step. In an
  /// ordinary log these are all rows but the first ones. Returns their number.
  std::size_t add_usual(std::span<const double> t);
  ClockSurvey result();

 private:
  void add_step(double step);
  void calibrate();
  void count(double step);

  std::array<double, 64> early_{};
  StepSums even_;    // longer steps are gaps
  StepSums longer_;  // those that are gaps of an even clock
  double first_ = 0, last_ = 0, last_step_ = 0, median_ = 0;
  std::size_t n_rows_ = 0, n_steps_ = 0, n_off_ = 0;
};

}  // namespace cablefit
