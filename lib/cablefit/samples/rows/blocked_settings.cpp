#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/rows/settings_parts.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr double kBlockedCutoff = 10;  // Hz; sweeps of a blocked link are slower than 1 Hz
constexpr double kSlowShare = 0.25;    // of the sweep speed that noise may reach, at four sd
constexpr double kRestShare = 0.05;    // of the sweep speed: slower is a reversal
constexpr double kStillShare = 0.05;   // of the link's speed: slower is standing still
constexpr double kSweepLag = 0.25;     // s over which a sweep's speed is measured

// Speed of a slow sweep: the upper quartile of |theta(t + lag) - theta(t)| / lag, so that holds and
// plateaus do not hide it, above what noise alone would show.
double sweep_speed(std::span<const LogSurvey> logs, const PartFilter& wanted, Channel channel,
                   int joint, double noise) {
  std::vector<double> speeds;
  for (const PreliminaryWindow& p : preliminary_windows(logs, wanted, {}, 0, kSettingsWindows)) {
    const int k = logs[p.log].plan.find(channel, joint);
    if (k < 0) continue;
    const auto theta = p.window.data.col(k);
    const auto lag =
        std::max<Eigen::Index>(1, static_cast<Eigen::Index>(kSweepLag / p.window.period));
    for (Eigen::Index i = lag; i < theta.size(); i += std::max<Eigen::Index>(1, lag / 4))
      speeds.push_back(std::abs(theta(i) - theta(i - lag)) /
                       (static_cast<double>(lag) * p.window.period));
  }
  if (speeds.empty()) return 0;
  const auto quartile = speeds.begin() + static_cast<long>(3 * speeds.size() / 4);
  std::nth_element(speeds.begin(), quartile, speeds.end());
  const double of_noise = std::sqrt(2.0) * noise / kSweepLag;
  return std::sqrt(std::max(0.0, *quartile * *quartile - of_noise * of_noise));
}

/// A sweep that repeats faster than a tenth of the cut-off is not quasi-static.
void warn_of_haste(std::span<const LogSurvey> logs, const PartFilter& wanted, int joint,
                   double sweep, double cutoff, ChosenSettings& chosen) {
  double range = 0;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      const int k = log.plan.find(Channel::theta, joint);
      if (k >= 0 && wanted(part))
        range = std::max(range, part.channels[static_cast<std::size_t>(k)].range());
    }
  if (!(range > 0) || cutoff <= 0) return;
  const double frequency = sweep / (2 * range);  // up and down once: twice the range
  if (frequency > 0.1 * cutoff)
    chosen.warnings.push_back(
        fmt::format("the motor sweeps about {:.2g} times a second: too fast for stage 1: inertia "
                    "and the filter bias stiffness and friction; sweep slower",
                    frequency));
}

/// `sweep`: its speed; `unseen`: speed that noise may be taken for, rad/s.
void choose_rest_speed(ChosenSettings& chosen, const SampleOptions& options, double sweep,
                       double unseen) {
  if (options.rest_speed) {
    chosen.rest_speed_theta = *options.rest_speed;
    decide(chosen, "rest speed", fmt::format("{:.3g}", chosen.rest_speed_theta), kByOption);
  } else if (unseen > kSlowShare * sweep) {
    // The motion is too slow for the encoder to separate it from rest row by row. Only the
    // direction of the last motion is known, which is sufficient for the branch.
    chosen.rest_speed_theta = 0;
    decide(
        chosen, "rest speed", "0",
        fmt::format("a sweep of {:.2g} rad/s is within the noise of the speed; each row takes the "
                    "direction of the last motion",
                    sweep));
  } else {
    chosen.rest_speed_theta = std::max(unseen, kRestShare * sweep);
    decide(
        chosen, "rest speed", fmt::format("{:.3g}", chosen.rest_speed_theta),
        fmt::format("{:g} of the sweep's speed, at least 4 sd of the speed's noise", kRestShare));
  }
}

}  // namespace

ChosenSettings blocked_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                const SampleOptions& options, int joint) {
  const RateRange rates = sample_rates(logs, wanted);
  const double rate = rates.lowest;  // what the slowest log can carry, all others can
  ChosenSettings chosen = begin_settings(logs, wanted, options, rates);
  const double noise = worst_noise(logs, wanted, Channel::theta, joint);
  const double sweep = sweep_speed(logs, wanted, Channel::theta, joint, noise);
  double& cutoff = chosen.rows.signal.cutoff;
  if (options.cutoff) {
    cutoff = *options.cutoff;
    decide(chosen, "cut-off", cutoff > 0 ? fmt::format("{:.4g} Hz", cutoff) : "none", kByOption);
  } else {
    cutoff = std::min(kBlockedCutoff, kMaxShareOfRate * rate);
    decide(chosen, "cut-off", fmt::format("{:.4g} Hz", cutoff), "quasi-static");
  }
  choose_decimation(chosen, options, rate);
  choose_edges(chosen, options, rates);
  const double band = cutoff > 0 ? cutoff : rate / 2;
  const double noise_q = worst_noise(logs, wanted, Channel::q, joint);
  chosen.rest_speed_q =
      std::max(4 * velocity_noise(noise_q, band, rate),
               kStillShare * sweep_speed(logs, wanted, Channel::q, joint, noise_q));
  choose_rest_margin(chosen, rate);
  choose_rest_speed(chosen, options, sweep, 4 * velocity_noise(noise, band, rate));
  const Rig& rig = first_log_with(logs, wanted).plan.rig;
  // Blocked logs do not show a hold: it looks like viscous friction, and in a sweep of one speed
  // like f_sm. identify() takes it from moving logs.
  chosen.rows.signal.torque_held = options.torque_hold.value_or(rig.torque_hold) == TorqueHold::zoh;
  chosen.rows.signal.torque_period = rig.torque_period;
  chosen.rows.signal.quasi_static = true;
  warn_of_haste(logs, wanted, joint, sweep, cutoff, chosen);
  return chosen;
}

}  // namespace cablefit
