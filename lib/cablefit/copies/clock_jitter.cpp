#include "cablefit/copies/clock_jitter.hpp"

#include <cmath>

#include "cablefit/samples/survey/channel_scan.hpp"

namespace cablefit {
namespace {

constexpr double kDependence = 2.9;  // as few sixth differences of white noise are independent

double noise_of(const Eigen::ArrayXd& x) {
  ChannelScan scan;
  scan.add(x);
  return scan.result().noise;
}

/// Covariance of the two positions' noise, rad^2: that of sum and difference, by polarisation.
double common_noise(const PositionPair& pair) {
  return (std::pow(noise_of(pair.q + pair.theta), 2) - std::pow(noise_of(pair.q - pair.theta), 2)) /
         4;
}

}  // namespace

double clock_jitter(const PositionPair& measured, const PositionPair& simulated,
                    const Eigen::ArrayXd& speeds) {
  const Eigen::Index n = measured.q.size();
  if (n == 0 || measured.theta.size() != n || simulated.q.size() != n ||
      simulated.theta.size() != n)
    return 0;
  const double common = common_noise(measured) - common_noise(simulated);
  const double chance = noise_of(measured.q) * noise_of(measured.theta) *
                        std::sqrt(kDependence / static_cast<double>(n));
  const double speed = speeds.mean();
  if (!(common > kJitterSd * chance) || !(speed > 0)) return 0;
  return std::sqrt(common / speed);
}

}  // namespace cablefit
