#include "cablefit/samples/survey/channel_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cablefit/base/parameter.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kOrder = 6;
constexpr double kVarianceGain = 924;  // C(12, 6)

double least_of(const Lanes& a) {
  return std::min(std::min(a.low[0], a.low[1]), std::min(a.high[0], a.high[1]));
}

/// The smallest step from one of n + 1 values to the next that is not 0; unbounded without one.
double smallest_step(const double* x, Eigen::Index n) {
  const Lanes none = all_lanes(kUnbounded), zero;
  const auto step = [&](const double* at) {
    const Lanes d = load(at + 1) + scaled(load(at), -1), size = greatest(d, scaled(d, -1));
    return Lanes{size.low > zero.low ? size.low : none.low,
                 size.high > zero.high ? size.high : none.high};
  };
  Lanes smallest = none, smallest2 = none;
  Eigen::Index i = 0;
  for (; i + 2 * kLanes <= n; i += 2 * kLanes) {
    smallest = least(smallest, step(x + i));
    smallest2 = least(smallest2, step(x + i + kLanes));
  }
  double found = least_of(least(smallest, smallest2));
  for (; i < n; ++i)
    if (x[i + 1] != x[i]) found = std::min(found, std::abs(x[i + 1] - x[i]));
  return found;
}

/// How far x[0] lies beyond both of its neighbours, on the same side; not positive: not at all.
double height_of(const double* x) {
  const double a = x[0] - x[-1], b = x[0] - x[1];
  return std::max(std::min(a, b), -std::max(a, b));
}

/// The largest height of n values.
double largest_height(const double* x, Eigen::Index n) {
  Lanes largest, largest2;
  const auto height = [](const double* at) {
    const Lanes minus = scaled(load(at), -1), a = minus + load(at - 1), b = minus + load(at + 1);
    return greatest(least(a, b), scaled(greatest(a, b), -1));
  };
  Eigen::Index i = 0;
  for (; i + 2 * kLanes <= n; i += 2 * kLanes) {
    largest = greatest(largest, height(x + i));
    largest2 = greatest(largest2, height(x + i + kLanes));
  }
  double found = -least_of(scaled(greatest(largest, largest2), -1));
  for (; i < n; ++i) found = std::max(found, height_of(x + i));
  return found;
}

}  // namespace

ValueRange value_range(const double* x, Eigen::Index n) {
  ValueRange range{x[0], x[0]};
  Lanes low = all_lanes(x[0]), high = low, low2 = low, high2 = low;
  Eigen::Index i = 0;
  for (; i + 2 * kLanes <= n; i += 2 * kLanes) {
    const Lanes a = load(x + i), b = load(x + i + kLanes);
    low = least(a, low), low2 = least(b, low2);
    high = greatest(a, high), high2 = greatest(b, high2);
  }
  for (; i < n; ++i) range = {std::min(range.low, x[i]), std::max(range.high, x[i])};
  range.low = std::min(range.low, least_of(least(low, low2)));
  range.high = std::max(range.high, -least_of(scaled(greatest(high, high2), -1)));
  return {range.low + 0.0, range.high + 0.0};  // never -0, which would depend on the order
}

void ChannelScan::add(const Values& x) {
  const ValueRange range = value_range(x.data(), x.size());
  look_at_limits(x, range.low, range.high);
  const bool stands_still = range.low == range.high && (recent_.head(n_known_) == range.low).all();
  if (stands_still)
    skip_differences(range.low, x.size());
  else
    look_at_differences(x);
  n_ += x.size();
}

void ChannelScan::look_at_limits(const Values& x, double low, double high) {
  if (low < min_) min_ = low, at_min_ = 0;
  if (high > max_) max_ = high, at_max_ = 0;
  const auto count = [&](double limit) { return low == high ? x.size() : (x == limit).count(); };
  if (low == min_) at_min_ += count(min_);
  if (high == max_) at_max_ += count(max_);
}

void ChannelScan::skip_differences(double value, Eigen::Index n_values) {
  const Eigen::Index n = n_known_ + n_values;
  n_d6_ += std::max<Eigen::Index>(0, n - kOrder);
  n_known_ = std::min(n, kOrder);
  if (recent_.size() < n_known_) recent_.resize(n_known_);
  recent_.head(n_known_).setConstant(value);
}

void ChannelScan::look_at_differences(const Values& x) {
  const Eigen::Index n = n_known_ + x.size();
  if (recent_.size() < n) recent_.conservativeResize(n);
  recent_.segment(n_known_, x.size()) = x;
  quantum_ = std::min(quantum_, smallest_step(recent_.data(), n - 1));
  look_for_lone_sample(n);
  add_sixth_differences(n - kOrder);
  n_known_ = std::min(n, kOrder);
  std::copy_n(recent_.data() + n - n_known_, n_known_, recent_.data());
}

void ChannelScan::look_for_lone_sample(Eigen::Index n) {
  const Eigen::Index begin = std::max<Eigen::Index>(1, n_known_ - 1), end = n - 1;
  if (begin >= end) return;
  // All at once first: hardly any stretch has a sample beyond all that were seen.
  if (!(largest_height(recent_.data() + begin, end - begin) > lone_.height)) return;
  for (Eigen::Index i = begin; i < end; ++i) {
    const double height = height_of(recent_.data() + i);
    if (height > lone_.height)
      lone_ = {height, recent_(i), static_cast<std::size_t>(n_ - n_known_ + i)};
  }
}

void ChannelScan::add_sixth_differences(Eigen::Index n) {
  const auto square = [this](Eigen::Index i) {
    const double* const x = recent_.data() + i;
    const double m = x[3];
    const double d =
        (x[0] - m) + (x[6] - m) - 6 * ((x[1] - m) + (x[5] - m)) + 15 * ((x[2] - m) + (x[4] - m));
    return d * d;
  };
  const auto add = [&](Eigen::Index i) {
    sums_d6_[static_cast<std::size_t>(n_d6_++ % kLanes)] += square(i);
  };
  // Relative to the middle value, so that a constant channel gives exactly 0, as in
  // skip_differences(). There are four sums; the number of a difference in the part selects one.
  // The rounding then does not depend on how many values the reader of a file delivers at a time.
  Eigen::Index i = 0;
  for (; i < n && n_d6_ % kLanes != 0; ++i) add(i);
  Lanes sums = load(sums_d6_.data());
  const Eigen::Index begin = i;
  for (; i + kLanes <= n; i += kLanes) {
    const double* const x = recent_.data() + i;
    const Lanes minus = scaled(load(x + 3), -1);
    const auto at = [&](Eigen::Index k) { return load(x + k) + minus; };
    const Lanes d = at(0) + at(6) + scaled(at(1) + at(5), -6) + scaled(at(2) + at(4), 15);
    sums.add_product(d, d);
  }
  n_d6_ += i - begin;
  store(sums, sums_d6_.data());
  for (; i < n; ++i) add(i);
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
  s.lone = lone_;
  if (max_ > min_) s.at_limits = static_cast<double>(at_min_ + at_max_) / static_cast<double>(n_);
  return s;
}

}  // namespace cablefit
