#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/rows/settings_parts.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr double kRigidShareOfRate = 0.1;
constexpr double kResonanceFactor = 2.5;  // the elastic torque's band: J_motor within 0.5 %
constexpr double kNoiseBias = 0.0025;     // largest share of noise in the acceleration's variance
constexpr double kLowestCutoff = 1;       // Hz

// The filter blurs a reversal over about 1/(2 pi cut-off): slower than the speed gained in that
// time the sign of the velocity is not known, however good the encoder.
double rest_speed(std::span<const LogSurvey> logs, const PartFilter& wanted,
                  const RowSettings& rows, PreliminaryMotion& motion, Channel channel,
                  double rate) {
  const double band = rows.signal.cutoff > 0 ? rows.signal.cutoff : rate / 2;
  const double noise =
      velocity_noise(worst_noise(logs, wanted, channel, motion.joint()), band, rate);
  const double blur = motion.acceleration(rows.signal, channel) / (2 * std::numbers::pi * band);
  // rad/s: a joint that shows neither noise nor motion stands still while others move.
  constexpr double kStandsStill = 1e-9;
  const bool beside_others = first_log_with(logs, wanted).plan.rig.n_joints() > 1;
  return std::max({4 * noise, blur, beside_others ? kStandsStill : 0});
}

void choose_rest_speed(ChosenSettings& chosen, std::span<const LogSurvey> logs,
                       const PartFilter& wanted, const SampleOptions& options,
                       PreliminaryMotion& motion, double rate) {
  RowSettings& rows = chosen.rows;
  if (options.rest_speed) {
    chosen.rest_speed_theta = chosen.rest_speed_q = *options.rest_speed;
    decide(chosen, "rest speed", fmt::format("{:.3g}", *options.rest_speed), kByOption);
  } else {
    chosen.rest_speed_theta = rest_speed(logs, wanted, rows, motion, Channel::theta, rate);
    RowSettings link = rows;
    link.signal.cutoff = chosen.cutoff_q;
    chosen.rest_speed_q = rest_speed(logs, wanted, link, motion, Channel::q, rate);
    decide(chosen, "rest speed",
           fmt::format("motor {:.3g}, link {:.3g}", chosen.rest_speed_theta, chosen.rest_speed_q),
           "speed gained within the filter's response time, at least 4 sd of the speed's "
           "noise");
  }
  if (chosen.rest_speed_theta > 0) choose_rest_margin(chosen, rate);
}

// Lowers the cut-off until position noise is a negligible part of the acceleration: noise in a
// regressor shrinks its coefficient by that share (errors in variables).
double quiet_cutoff(std::span<const LogSurvey> logs, const PartFilter& wanted,
                    const RowSettings& rows, PreliminaryMotion& motion, Channel channel,
                    double cutoff, double rate) {
  const double noise = worst_noise(logs, wanted, channel, motion.joint());
  RowSettings trial = rows;
  for (;; cutoff *= 0.8) {
    trial.signal.cutoff = cutoff;
    if (cutoff <= kLowestCutoff || noise == 0) return cutoff;
    const double total = motion.acceleration(trial.signal, channel);
    const double noisy = acceleration_noise(noise, cutoff, rate);
    if (total == 0 || noisy * noisy <= kNoiseBias * total * total) return cutoff;
  }
}

// The link's encoder may be coarser than the motor's: its equation then gets a lower cut-off of its
// own, all its columns alike.
void choose_link_cutoff(ChosenSettings& chosen, std::span<const LogSurvey> logs,
                        const PartFilter& wanted, const SampleOptions& options,
                        PreliminaryMotion& motion, double rate) {
  chosen.cutoff_q = chosen.rows.signal.cutoff;
  if (options.cutoff || !first_log_with(logs, wanted).plan.has(Channel::q, motion.joint())) return;
  chosen.cutoff_q =
      quiet_cutoff(logs, wanted, chosen.rows, motion, Channel::q, chosen.cutoff_q, rate);
  chosen.rows.lowest_cutoff = chosen.cutoff_q;
  if (chosen.cutoff_q < chosen.rows.signal.cutoff)
    decide(chosen, "cut-off of the link equation", fmt::format("{:.4g} Hz", chosen.cutoff_q),
           fmt::format("noise of q below {:g} % of the acceleration's variance", 100 * kNoiseBias));
}

void choose_moving_cutoff(ChosenSettings& chosen, std::span<const LogSurvey> logs,
                          const PartFilter& wanted, const SampleOptions& options,
                          PreliminaryMotion& motion, double resonance, double rate) {
  double& cutoff = chosen.rows.signal.cutoff;
  if (options.cutoff) {
    cutoff = *options.cutoff;
    decide(chosen, "cut-off", cutoff > 0 ? fmt::format("{:.4g} Hz", cutoff) : "none", kByOption);
  } else {
    const double wish = resonance > 0
                            ? std::min(kResonanceFactor * resonance, kMaxShareOfRate * rate)
                            : kRigidShareOfRate * rate;
    cutoff = quiet_cutoff(logs, wanted, chosen.rows, motion, Channel::theta, wish, rate);
    std::string reason = resonance > 0 && wish < kMaxShareOfRate * rate
                             ? fmt::format("{:g} times the free resonance under load, {:.3g} Hz",
                                           kResonanceFactor, resonance)
                             : fmt::format("{:g} of the sample rate", wish / rate);
    if (cutoff < wish)
      reason = fmt::format("position noise below {:g} % of the acceleration's variance",
                           100 * kNoiseBias);
    decide(chosen, "cut-off", fmt::format("{:.4g} Hz", cutoff), reason);
  }
  choose_link_cutoff(chosen, logs, wanted, options, motion, rate);
}

}  // namespace

ChosenSettings moving_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                               const SampleOptions& options, double resonance, int joint) {
  const RateRange rates = sample_rates(logs, wanted);
  const double rate = rates.lowest;  // what the slowest log can carry, all others can
  ChosenSettings chosen = begin_settings(logs, wanted, options, rates);
  chosen.resonance = resonance;
  PreliminaryMotion motion(logs, wanted, joint);
  choose_moving_cutoff(chosen, logs, wanted, options, motion, resonance, rate);
  choose_decimation(chosen, options, rate);
  choose_edges(chosen, options, rates);
  choose_rest_speed(chosen, logs, wanted, options, motion, rate);
  return chosen;
}

}  // namespace cablefit
