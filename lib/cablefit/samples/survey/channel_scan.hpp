// Running statistics of one channel: range, quantum, noise, saturation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

namespace cablefit {

/// Statistics of one channel within one part. SI.
struct ChannelSurvey {
  double min = 0, max = 0;
  double quantum = 0;    ///< smallest step between neighbours; 0 for a constant
  double noise = 0;      ///< sd of white noise, from sixth differences (they remove smooth motion)
  double at_limits = 0;  ///< share of rows exactly at min or max; a large share means saturation
  double range() const { return max - min; }
};

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
  void look_at_limits(const Values& x);
  void look_at_differences(const Values& x);
  /// Steps to the values [begin, end) of recent_, each from the one before.
  void look_at_steps(Eigen::Index begin, Eigen::Index end);
  /// The first n that recent_ gives.
  void add_sixth_differences(Eigen::Index n);

  double min_ = std::numeric_limits<double>::infinity(), max_ = -min_, quantum_ = min_;
  static constexpr Eigen::Index kSums = 4;
  std::array<double, kSums> sums_d6_{};
  Eigen::Index n_ = 0, n_d6_ = 0, at_min_ = 0, at_max_ = 0;
  Eigen::ArrayXd recent_;     // the last values known, then those being added
  Eigen::Index n_known_ = 0;  // values at the front of recent_ that differences may reach back to
};

}  // namespace cablefit
