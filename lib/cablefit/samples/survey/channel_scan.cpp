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
  for (Eigen::Index i = std::max<Eigen::Index>(1, n_known_); i < n; ++i) {
    const double step = std::abs(recent_(i) - recent_(i - 1));
    if (step < quantum_ && step > 0) quantum_ = step;
  }
  const Eigen::Index m = n - kOrder;
  if (m > 0) {
    const auto at = [&](Eigen::Index k) { return recent_.segment(k, m); };
    sum_d6_ +=
        (at(0) + at(6) - 6 * (at(1) + at(5)) + 15 * (at(2) + at(4)) - 20 * at(3)).square().sum();
    n_d6_ += m;
  }
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
