#include "cablefit/refine/rows/rough_start.hpp"

#include <algorithm>

#include "cablefit/refine/rows/kernel.hpp"
#include "cablefit/refine/rows/motion.hpp"

namespace cablefit {
namespace {

constexpr double kRough = 3;  // times the largest acceleration later: it happens once only
constexpr double kLongestStart = 0.06;  // s: what oscillates longer is slow enough for the kernels

/// Samples up to the last rough one of the start; 0: none is rough.
Eigen::Index rough_samples(const Eigen::ArrayXd& positions, const Smoothing& smoothing,
                           double period) {
  const Kernel curvature = gaussian_curvature(smoothing.signals, period);
  const Eigen::Index n = positions.size(), reach = curvature.reach();
  const auto end = static_cast<Eigen::Index>(kLongestStart / period);
  if (n < 2 * (end + reach)) return 0;
  const Eigen::ArrayXd acceleration = apply(curvature, positions).abs();
  const double later = acceleration.segment(end, n - end - reach).maxCoeff();
  Eigen::Index last = 0;
  for (Eigen::Index i = reach; i < end; ++i)
    if (acceleration(i) > kRough * later) last = i;
  return last;
}

}  // namespace

Eigen::Index rough_start(const Recording& recording) {
  const Smoothing smoothing = smoothing_for(recording.period);
  Eigen::Index last = std::max(rough_samples(recording.q, smoothing, recording.period),
                               rough_samples(recording.theta, smoothing, recording.period));
  for (Eigen::Index k = 0; k < recording.links.cols(); ++k)
    last = std::max(last, rough_samples(recording.links.col(k), smoothing, recording.period));
  if (last == 0) return 0;
  return last + gaussian(smoothing.signals, recording.period).reach() +
         gaussian(smoothing.columns, recording.period).reach();
}

}  // namespace cablefit
