#include "cablefit/figure/binned_mean.hpp"

#include <cmath>
#include <limits>

namespace cablefit {

BinnedMean::BinnedMean(std::size_t n_bins) : x_(n_bins), bins_(n_bins) {}

void BinnedMean::add(double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  while (!x_.covers(x)) widen(x);
  Bin& bin = bins_[x_.bin_of(x)];
  bin.x += x;
  bin.y += y;
  ++bin.n;
}

void BinnedMean::widen(double x) {
  const bool first = !x_.is_set();
  x_.widen(x);
  if (first) return;
  std::vector<Bin> joined(bins_.size());
  for (std::size_t k = 0; k < bins_.size(); ++k) {
    Bin& bin = joined[(k + x_.shift()) / 2];
    bin.x += bins_[k].x;
    bin.y += bins_[k].y;
    bin.n += bins_[k].n;
  }
  bins_ = std::move(joined);
}

void BinnedMean::draw(Trace& trace, std::size_t min_rows, bool break_at_holes) const {
  trace.x.clear();
  trace.y.clear();
  bool hole = false;
  for (const Bin& bin : bins_) {
    if (bin.n == 0 || bin.n < min_rows) {
      hole = !trace.x.empty();
      continue;
    }
    const auto n = static_cast<double>(bin.n);
    if (hole && break_at_holes) {
      trace.x.push_back(bin.x / n);
      trace.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    hole = false;
    trace.x.push_back(bin.x / n);
    trace.y.push_back(bin.y / n);
  }
}

}  // namespace cablefit
