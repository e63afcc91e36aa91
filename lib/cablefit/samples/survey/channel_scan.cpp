#include "cablefit/samples/survey/channel_scan.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

constexpr Eigen::Index kOrder = 6;
constexpr double kVarianceGain = 924;  // C(12, 6)

}  // namespace

void ChannelScan::add(const Values& x) {
  look_at_limits(x);
  look_at_differences(x);
  n_ += x.size();
}

void ChannelScan::look_at_limits(const Values& x) {
  const double low = x.minCoeff(), high = x.maxCoeff();
  if (low < min_) min_ = low, at_min_ = 0;
  if (high > max_) max_ = high, at_max_ = 0;
  if (low == min_) at_min_ += (x == min_).count();
  if (high == max_) at_max_ += (x == max_).count();
}

void ChannelScan::look_at_differences(const Values& x) {
  const Eigen::Index n = n_known_ + x.size();
  if (recent_.size() < n) recent_.conservativeResize(n);
  recent_.segment(n_known_, x.size()) = x;
  double quantum = quantum_, sum_d6 = sum_d6_;  // copies stay in registers
  for (Eigen::Index i = std::max<Eigen::Index>(1, n_known_); i < n; ++i) {
    const double step = std::abs(recent_(i) - recent_(i - 1));
    if (step < quantum && step > 0) quantum = step;
  }
  const Eigen::Index m = n - kOrder;
  // One after the other: how many values come at a time is as the reader of a file has them, and
  // must not show in the rounding.
  for (Eigen::Index i = 0; i < m; ++i) {
    const double* const x6 = recent_.data() + i;
    const double d6 = x6[0] + x6[6] - 6 * (x6[1] + x6[5]) + 15 * (x6[2] + x6[4]) - 20 * x6[3];
    sum_d6 += d6 * d6;
  }
  quantum_ = quantum;
  sum_d6_ = sum_d6;
  n_d6_ += std::max<Eigen::Index>(0, m);
  n_known_ = std::min(n, kOrder);
  std::copy_n(recent_.data() + n - n_known_, n_known_, recent_.data());
}

ChannelSurvey ChannelScan::result() const {
  ChannelSurvey s;
  if (n_ == 0) return s;
  s.min = min_;
  s.max = max_;
  s.quantum = std::isfinite(quantum_) ? quantum_ : 0;
  if (n_d6_ > 0) s.noise = std::sqrt(sum_d6_ / static_cast<double>(n_d6_) / kVarianceGain);
  if (max_ > min_) s.at_limits = static_cast<double>(at_min_ + at_max_) / static_cast<double>(n_);
  return s;
}

}  // namespace cablefit
