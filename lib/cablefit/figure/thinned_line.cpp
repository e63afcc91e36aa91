#include "cablefit/figure/thinned_line.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/base/parameter.hpp"

namespace cablefit {
namespace {

constexpr double kRounding = 1.001;  // so that two rows a spacing apart never skip a bucket

void add_point(double x, double y, Trace& trace) {
  trace.x.push_back(x);
  trace.y.push_back(y);
}

}  // namespace

ThinnedLine::ThinnedLine(double begin, double end, double spacing) : begin_(begin) {
  const double length = std::max(end - begin, 0.0);
  width_ = std::max(length / static_cast<double>(kMostBuckets), kRounding * spacing);
  if (!(width_ > 0)) width_ = 1;
  buckets_.resize(std::min(kMostBuckets, static_cast<std::size_t>(length / width_) + 1));
}

void ThinnedLine::add(double t, double value) {
  if (!std::isfinite(value) || !std::isfinite(t)) return;
  const double last = static_cast<double>(buckets_.size() - 1);
  const double place = std::clamp(std::floor((t - begin_) / width_), 0.0, last);
  Bucket& bucket = buckets_[static_cast<std::size_t>(place)];
  if (!bucket.filled) {
    bucket = {t, value, t, value, true};
    return;
  }
  if (value < bucket.low) {
    bucket.low = value;
    bucket.t_low = t;
  }
  if (value > bucket.high) {
    bucket.high = value;
    bucket.t_high = t;
  }
}

void ThinnedLine::draw_bucket(const Bucket& bucket, bool alone, Trace& trace) const {
  const bool rises = bucket.t_low <= bucket.t_high;
  add_point(rises ? bucket.t_low : bucket.t_high, rises ? bucket.low : bucket.high, trace);
  const bool one_row = bucket.t_low == bucket.t_high;
  if (!one_row) {
    add_point(rises ? bucket.t_high : bucket.t_low, rises ? bucket.high : bucket.low, trace);
  } else if (alone) {  // a line of one point would not be seen
    add_point(bucket.t_low + width_ / 2, bucket.low, trace);
  }
}

void ThinnedLine::draw(Trace& trace) const {
  trace.x.clear();
  trace.y.clear();
  for (std::size_t k = 0; k < buckets_.size(); ++k) {
    const bool after_hole = k == 0 || !buckets_[k - 1].filled;
    const bool before_hole = k + 1 == buckets_.size() || !buckets_[k + 1].filled;
    if (buckets_[k].filled) {
      draw_bucket(buckets_[k], after_hole && before_hole, trace);
    } else if (!after_hole) {
      add_point(begin_ + static_cast<double>(k) * width_, kNotKnown, trace);
    }
  }
}

}  // namespace cablefit
