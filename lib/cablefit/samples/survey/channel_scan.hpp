// Running statistics of one channel: range, quantum, noise, saturation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>

#include "cablefit/base/lanes.hpp"

namespace cablefit {

/// Statistics of one channel within one part. SI.
struct ChannelSurvey {
  double min = 0, max = 0;
  double quantum = 0;    ///< smallest step between neighbours; 0 for a constant
  double noise = 0;      ///< sd of white noise, from sixth differences (they remove smooth motion)
  double at_limits = 0;  ///< share of rows exactly at min or max; a large share means saturation
  /// The sample that differs most from both of its neighbours, in the same direction. `height`:
  /// from the nearer one, in the channel's SI unit, 0 when there is no such sample. `place`: its
  /// number among the samples of the part. Samples across a gap in time are not neighbours.
  struct LoneSample {
    double height = 0, value = 0;
    std::size_t place = 0;
  } lone;
  double range() const { return max - min; }
};

struct ValueRange {
  double low, high;
};
/// Smallest and largest of n > 0 values. Infinities count; NaN does not,
/// unless it is the first value: then both are NaN.
ValueRange value_range(const double* x, Eigen::Index n);

/// Sixth differences remove any motion that a fifth-order polynomial describes over seven samples.
/// For white noise their variance is C(12,6) = 924 times that of the noise.
class ChannelScan {
 public:
  using Values = Eigen::Ref<const Eigen::ArrayXd>;
  /// Adds the next values; `x` must not be empty. Differences include earlier values unless
  /// restart() was called.
  void add(const Values& x);
  void restart() { n_known_ = 0; }
  ChannelSurvey result() const;

 private:
  void look_at_limits(const Values& x, double low, double high);
  void look_at_differences(const Values& x);
  /// For values that are all equal, and equal to the known ones: all differences are 0.
  void skip_differences(double value, Eigen::Index n_values);
  /// Among the first n values of recent_.
  void look_for_lone_sample(Eigen::Index n);
  /// The first n that recent_ gives.
  void add_sixth_differences(Eigen::Index n);

  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_, quantum_ = min_;
  std::array<double, kLanes> sums_d6_{};
  ChannelSurvey::LoneSample lone_;
  Eigen::Index n_ = 0, n_d6_ = 0, at_min_ = 0, at_max_ = 0;
  Eigen::ArrayXd recent_;     // the last values known, then those being added
  Eigen::Index n_known_ = 0;  // values at the front of recent_ that differences may reach back to
};

}  // namespace cablefit
