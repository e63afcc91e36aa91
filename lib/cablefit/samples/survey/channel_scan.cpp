#include "cablefit/samples/survey/channel_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cablefit/base/parameter.hpp"

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
  const auto count = [&](double limit) { return low == high ? x.size() : (x == limit).count(); };
  if (low == min_) at_min_ += count(min_);
  if (high == max_) at_max_ += count(max_);
}

void ChannelScan::look_at_differences(const Values& x) {
  const Eigen::Index n = n_known_ + x.size();
  if (recent_.size() < n) recent_.conservativeResize(n);
  recent_.segment(n_known_, x.size()) = x;
  look_at_steps(std::max<Eigen::Index>(1, n_known_), n);
  add_sixth_differences(n - kOrder);
  n_known_ = std::min(n, kOrder);
  std::copy_n(recent_.data() + n - n_known_, n_known_, recent_.data());
}

void ChannelScan::look_at_steps(Eigen::Index begin, Eigen::Index end) {
  const Eigen::Index n = end - begin;
  if (n <= 0) return;
  const auto steps = (recent_.segment(begin, n) - recent_.segment(begin - 1, n)).abs();
  // Quick, and enough for a channel that moves all the time.
  if (!(steps.minCoeff() < quantum_)) return;
  quantum_ = std::min(quantum_, (steps > 0).select(steps, kUnbounded).minCoeff());
}

void ChannelScan::add_sixth_differences(Eigen::Index n) {
  const auto square = [this](Eigen::Index i) {
    const double* const x = recent_.data() + i;
    const double d = x[0] + x[6] - 6 * (x[1] + x[5]) + 15 * (x[2] + x[4]) - 20 * x[3];
    return d * d;
  };
  // Four sums side by side. Which one a difference goes to depends on its number in the part: how
  // many values come at a time is as the reader of a file has them, and must not show in the
  // rounding.
  Eigen::Index i = 0;
  for (; i < n && n_d6_ % kSums != 0; ++i) sums_d6_[n_d6_++ % kSums] += square(i);
  std::array<double, kSums> sums = sums_d6_;
  const Eigen::Index begin = i;
  for (; i + kSums <= n; i += kSums)
    for (Eigen::Index k = 0; k < kSums; ++k) sums[k] += square(i + k);
  n_d6_ += i - begin;
  sums_d6_ = sums;
  for (; i < n; ++i) sums_d6_[n_d6_++ % kSums] += square(i);
}

ChannelSurvey ChannelScan::result() const {
  ChannelSurvey s;
  if (n_ == 0) return s;
  s.min = min_;
  s.max = max_;
  s.quantum = std::isfinite(quantum_) ? quantum_ : 0;
  if (n_d6_ > 0) {
    const double sum = std::accumulate(sums_d6_.begin(), sums_d6_.end(), 0.0);
    s.noise = std::sqrt(sum / static_cast<double>(n_d6_) / kVarianceGain);
  }
  if (max_ > min_) s.at_limits = static_cast<double>(at_min_ + at_max_) / static_cast<double>(n_);
  return s;
}

}  // namespace cablefit
