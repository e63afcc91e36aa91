#include "cablefit/figure/growing_bins.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

// The first width: far below anything a plot resolves, far above the rounding of the value.
constexpr double kFirstWidth = 1e-9;

}  // namespace

bool GrowingBins::covers(double value) const {
  return is_set() && value >= begin_ && value < begin_ + static_cast<double>(n_) * width_;
}

void GrowingBins::widen(double value) {
  const auto n = static_cast<double>(n_);
  if (!is_set()) {
    width_ = kFirstWidth * std::max(std::abs(value), 1e-3);
    begin_ = value - std::floor(n / 2) * width_;
    return;
  }
  shift_ = value < begin_ ? n_ : 0;
  if (shift_ > 0) begin_ -= n * width_;
  width_ *= 2;
}

std::size_t GrowingBins::bin_of(double value) const {
  const auto bin = static_cast<std::size_t>((value - begin_) / width_);
  return std::min(bin, n_ - 1);
}

}  // namespace cablefit
