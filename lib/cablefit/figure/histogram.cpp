#include "cablefit/figure/histogram.hpp"

#include <cmath>
#include <numbers>

namespace cablefit {
namespace {

constexpr std::size_t kBins = 80;
constexpr double kWidth = 2 * kHistogramReach / static_cast<double>(kBins);
using std::numbers::pi;

}  // namespace

Histogram::Histogram() : counts_(kBins, 0) {}

void Histogram::add(double value) {
  if (std::isnan(value)) return;
  ++n_;
  const double place = (value + kHistogramReach) / kWidth;
  if (place < 0 || place >= static_cast<double>(kBins)) {
    ++n_beyond_;
  } else {
    ++counts_[static_cast<std::size_t>(place)];
  }
}

void Histogram::draw(Trace& trace) const {
  for (std::size_t k = 0; k < kBins; ++k) {
    trace.x.push_back(-kHistogramReach + (static_cast<double>(k) + 0.5) * kWidth);
    const double share = static_cast<double>(counts_[k]) / static_cast<double>(n_ > 0 ? n_ : 1);
    trace.y.push_back(share / kWidth);
  }
}

double Histogram::share_beyond() const {
  return n_ > 0 ? static_cast<double>(n_beyond_) / static_cast<double>(n_) : 0;
}

void Histogram::draw_normal(Trace& trace) {
  for (std::size_t k = 0; k <= kBins; ++k) {
    const double z = -kHistogramReach + static_cast<double>(k) * kWidth;
    trace.x.push_back(z);
    trace.y.push_back(std::exp(-z * z / 2) / std::sqrt(2 * pi));
  }
}

}  // namespace cablefit
