#include "cablefit/predict/window_series.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {

WindowSeries::WindowSeries(double seconds, double row_seconds)
    : row_seconds_(row_seconds),
      n_rows_(std::max<Eigen::Index>(
          1, static_cast<Eigen::Index>(std::llround(seconds / row_seconds)))) {}

void WindowSeries::add(const std::vector<double>& t, const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < t.size(); ++i) {
    // By time: rows that lie half way between the places of a grid round to either.
    const double step = t[i] - last_;
    const bool is_next = step > 0 && step < 1.5 * row_seconds_;
    const bool goes_on = is_next && n_seen_ > 0 && n_seen_ < n_rows_;
    last_ = t[i];
    if (!goes_on) {
      from_ = t[i];
      n_seen_ = 0;
      sum_ = 0;
    }
    sum_ += values(static_cast<Eigen::Index>(i));
    if (++n_seen_ == n_rows_) means_.push_back({from_, sum_ / static_cast<double>(n_rows_)});
  }
}

double rms_of(const std::vector<WindowSeries::Mean>& means) {
  double squares = 0;
  for (const WindowSeries::Mean& mean : means) squares += mean.value * mean.value;
  return means.empty() ? 0 : std::sqrt(squares / static_cast<double>(means.size()));
}

double robust_sd_of(const std::vector<WindowSeries::Mean>& means) {
  if (means.empty()) return 0;
  std::vector<double> sizes;
  for (const WindowSeries::Mean& mean : means) sizes.push_back(std::abs(mean.value));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  constexpr double kNormal = 1.4826;  // sd of a normal distribution over the median magnitude
  return kNormal * *middle;
}

}  // namespace cablefit
