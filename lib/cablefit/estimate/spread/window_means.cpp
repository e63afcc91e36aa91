#include "cablefit/estimate/spread/window_means.hpp"

#include <cmath>

namespace cablefit {

void WindowMeans::add(std::span<const Eigen::Index> numbers,
                      const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    for (std::size_t k = 0; k < kLengths; ++k) {
      Length& length = lengths_[k];
      const Eigen::Index window = numbers[i] >> k, size = Eigen::Index{1} << k;
      if (window != length.window) length.window = window, length.n_rows = 0, length.sum = 0;
      length.sum += values(static_cast<Eigen::Index>(i));
      if (++length.n_rows < size) continue;
      const double mean = length.sum / static_cast<double>(size);
      length.squares += mean * mean;
      length.n_windows += 1;
    }
}

std::vector<WindowMean> WindowMeans::result(double row_seconds) const {
  std::vector<WindowMean> all;
  for (std::size_t k = 0; k < kLengths; ++k) {
    const Length& length = lengths_[k];
    if (length.n_windows < kFewWindows) break;
    all.push_back({row_seconds * static_cast<double>(Eigen::Index{1} << k),
                   std::sqrt(length.squares / length.n_windows)});
  }
  return all;
}

}  // namespace cablefit
