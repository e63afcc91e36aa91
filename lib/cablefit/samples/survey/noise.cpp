#include "cablefit/samples/survey/noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cablefit {

double position_noise(const LogSurvey& log, const PartSurvey& part, Channel channel, int joint) {
  const int k = log.plan.find(channel, joint);
  if (k < 0) return 0;
  const Rig& rig = log.plan.rig;
  const std::string name(channel_name(channel));
  const auto sensor =
      rig.sensors.find(rig.n_joints() > 1 ? name + std::to_string(joint + 1) : name);
  if (sensor != rig.sensors.end()) {
    const double quantum = sensor->second.quantum.value_or(0) / std::sqrt(12.0);
    const double noise = sensor->second.noise.value_or(0);
    if (quantum > 0 || noise > 0) return std::hypot(quantum, noise);
  }
  const ChannelSurvey& c = part.channels[static_cast<std::size_t>(k)];
  return std::max(c.noise, c.quantum / std::sqrt(12.0));
}

double velocity_noise(double noise, double cutoff, double rate) {
  // Power of white noise is noise^2 over 0..rate/2; differentiation weighs it with (2 pi f)^2.
  return noise * 2 * std::numbers::pi * std::sqrt(std::pow(cutoff, 3) / 3 * 2 / rate);
}

double acceleration_noise(double noise, double cutoff, double rate) {
  return noise * 4 * std::numbers::pi * std::numbers::pi *
         std::sqrt(std::pow(cutoff, 5) / 5 * 2 / rate);
}

}  // namespace cablefit
