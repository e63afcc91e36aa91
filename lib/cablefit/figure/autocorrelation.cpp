#include "cablefit/figure/autocorrelation.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

Autocorrelation::Autocorrelation()
    : products_(static_cast<std::size_t>(kMostLags) + 1, 0), pairs_(products_) {}

void Autocorrelation::keep_tail() {
  const auto tail = static_cast<std::size_t>(kMostLags);
  if (values_.size() <= tail) return;
  const auto drop = static_cast<std::ptrdiff_t>(values_.size() - tail);
  values_.erase(values_.begin(), values_.begin() + drop);
  marks_.erase(marks_.begin(), marks_.begin() + drop);
  first_number_ += drop;
}

void Autocorrelation::add(const std::vector<Eigen::Index>& numbers,
                          const Eigen::Ref<const Eigen::VectorXd>& values) {
  if (numbers.empty()) return;
  keep_tail();
  const auto next = first_number_ + static_cast<Eigen::Index>(values_.size());
  if (values_.empty() || numbers.front() < next || numbers.front() > next + kMostLags) {
    values_.clear();
    marks_.clear();
    first_number_ = numbers.front();
  }
  const auto old = static_cast<Eigen::Index>(values_.size());
  const auto size = static_cast<std::size_t>(numbers.back() - first_number_ + 1);
  values_.resize(size, 0);
  marks_.resize(size, 0);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto at = static_cast<std::size_t>(numbers[i] - first_number_);
    values_[at] = values(static_cast<Eigen::Index>(i));
    marks_[at] = 1;
  }
  squares_ += values.squaredNorm();
  n_ += static_cast<double>(numbers.size());
  const Eigen::Map<const Eigen::VectorXd> v(values_.data(), static_cast<Eigen::Index>(size));
  const Eigen::Map<const Eigen::VectorXd> m(marks_.data(), static_cast<Eigen::Index>(size));
  for (Eigen::Index lag = 1; lag <= kMostLags; ++lag) {
    const Eigen::Index from = std::max(old, lag);  // the later row of a pair is new
    const Eigen::Index n = v.size() - from;
    if (n <= 0) continue;
    const auto k = static_cast<std::size_t>(lag);
    products_[k] += v.segment(from, n).dot(v.segment(from - lag, n));
    pairs_[k] += m.segment(from, n).dot(m.segment(from - lag, n));
  }
}

void Autocorrelation::draw(Trace& trace) const {
  const double variance = n_ > 0 ? squares_ / n_ : 0;
  for (std::size_t lag = 1; lag < pairs_.size(); ++lag) {
    if (!(pairs_[lag] > 0) || !(variance > 0)) continue;
    trace.x.push_back(static_cast<double>(lag));
    trace.y.push_back(products_[lag] / pairs_[lag] / variance);
  }
}

double Autocorrelation::white_band() const { return n_ > 0 ? 1.96 / std::sqrt(n_) : 0; }

}  // namespace cablefit
