// Running statistics of one channel: range, quantum, noise, saturation.
#pragma once

#include <Eigen/Core>
#include <limits>

namespace cablefit {

/// What one channel looks like within one part. SI.
struct ChannelSurvey {
  double min = 0, max = 0;
  double quantum = 0;    ///< smallest step between neighbours that occurs, 0 for a constant
  double noise = 0;      ///< sd of white noise, from sixth differences (they remove smooth motion)
  double at_limits = 0;  ///< share of rows exactly at min or max: saturation when large
  double range() const { return max - min; }
};

/// Sixth differences remove any motion that a fifth-order polynomial follows over seven samples;
/// for white noise their variance is C(12,6) = 924 times its own.
class ChannelScan {
 public:
  using Values = Eigen::Ref<const Eigen::ArrayXd>;
  /// The next values; `x` must not be empty. Differences reach back to the values before unless
  /// restart() came between.
  void add(const Values& x);
  void restart() { n_known_ = 0; }
  ChannelSurvey result() const;

 private:
  void look_at_limits(const Values& x);
  void look_at_differences(const Values& x);

  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_, quantum_ = min_;
  double sum_d6_ = 0;
  Eigen::Index n_ = 0, n_d6_ = 0, at_min_ = 0, at_max_ = 0;
  Eigen::ArrayXd recent_;     // the last values known, then those being added
  Eigen::Index n_known_ = 0;  // values at the front of recent_ that differences may reach back to
};

}  // namespace cablefit
