#include "cablefit/samples/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/samples/agreement.hpp"
#include "cablefit/samples/pilot.hpp"

namespace cablefit {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kBlockedCutoff = 10;    // Hz; sweeps of a blocked link are slower than 1 Hz
constexpr double kMaxShareOfRate = 0.2;  // beyond it a five-point difference is off by 1 %
constexpr double kRigidShareOfRate = 0.1;
constexpr double kResonanceFactor =
    2.5;                               // the elastic torque's band: J_motor within 0.5 % (README)
constexpr double kNoiseBias = 0.0025;  // largest share of noise in the acceleration's variance
constexpr double kSamplesPerPeriod = 2.5;  // rows per period of the cut-off after decimation
constexpr double kLowestCutoff = 1;
constexpr double kRateSpread = 1.01;  // rates closer than this are one
constexpr double kSlowShare = 0.25;   // of the sweep speed that noise may reach, at four sd
constexpr double kRestShare = 0.05;   // of the sweep speed: slower is a reversal
constexpr double kStillShare = 0.05;  // of the link's speed: slower is standing still
constexpr double kSweepLag = 0.25;    // s over which a sweep's speed is measured

double worst_noise(std::span<const LogSurvey> logs, const PartFilter& wanted, Channel channel) {
  double worst = 0;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part)) worst = std::max(worst, position_noise(log, part, channel));
  return worst;
}

void decide(ChosenSettings& chosen, std::string name, std::string value, std::string reason) {
  chosen.decisions.push_back({std::move(name), std::move(value), std::move(reason)});
}

const char* kByOption = "given";

/// Options that no log can meet.
void check_options(std::span<const LogSurvey> logs, const PartFilter& wanted,
                   const SampleOptions& options, double rate) {
  double longest = 0;  // s
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (wanted(part)) longest = std::max(longest, part.period * static_cast<double>(part.n_rows));
  if (options.cutoff && *options.cutoff > 0 && *options.cutoff * longest < 2)
    throw usage_error(
        fmt::format("--cutoff {:g} Hz has a period as long as the longest log ({:.3g} s)",
                    *options.cutoff, longest),
        "choose a higher cut-off, or 0 for no filter");
  if (options.drop_edge && static_cast<double>(*options.drop_edge) > longest * rate / 2)
    throw usage_error(fmt::format("--drop-edge {} leaves nothing of the longest log ({:.0f} rows)",
                                  *options.drop_edge, longest * rate),
                      "drop fewer rows");
  if (options.decimate && *options.decimate > longest * rate / 10)
    throw usage_error(fmt::format("--decimate {} leaves fewer than ten rows", *options.decimate),
                      "decimate less");
  if (options.cutoff && *options.cutoff >= 0.45 * rate)
    throw usage_error(fmt::format("--cutoff {:g} is not below 0.45 of the sample rate of {:.4g} Hz",
                                  *options.cutoff, rate),
                      "choose a lower cut-off, or 0 for no filter");
}

void choose_decimation(ChosenSettings& chosen, const SampleOptions& options, double rate) {
  RowSettings& rows = chosen.rows;
  if (options.decimate) {
    rows.decimate = *options.decimate;
    decide(chosen, "decimation", std::to_string(rows.decimate), kByOption);
    return;
  }
  if (rows.signal.cutoff > 0)
    rows.decimate = std::max(1, static_cast<int>(rate / (kSamplesPerPeriod * rows.signal.cutoff)));
  decide(chosen, "decimation", std::to_string(rows.decimate),
         rows.signal.cutoff > 0
             ? fmt::format("{:g} rows a period of the cut-off", kSamplesPerPeriod)
             : "no filter, no decimation");
}

void choose_edges(ChosenSettings& chosen, const SampleOptions& options, double rate) {
  RowSettings& rows = chosen.rows;
  if (options.drop_edge) {
    rows.drop_edge = std::max<Eigen::Index>(*options.drop_edge, kDifferenceEdge);
    decide(chosen, "edge rows", std::to_string(rows.drop_edge), kByOption);
    return;
  }
  const double cutoff = rows.signal.cutoff;
  rows.drop_edge =
      cutoff > 0 ? std::max<Eigen::Index>(kDifferenceEdge,
                                          static_cast<Eigen::Index>(std::ceil(2 * rate / cutoff)))
                 : kDifferenceEdge;
  decide(chosen, "edge rows", std::to_string(rows.drop_edge),
         cutoff > 0 ? "two periods of the cut-off" : "what differences cannot reach");
}

void choose_filter_order(ChosenSettings& chosen, const SampleOptions& options) {
  chosen.rows.signal.filter_order = options.filter_order.value_or(4);
  decide(chosen, "filter order", std::to_string(chosen.rows.signal.filter_order),
         options.filter_order ? kByOption : "Butterworth, forward and backward");
}

// Speed of a slow sweep: the upper quartile of |theta(t + lag) - theta(t)| / lag, so that holds and
// plateaus do not hide it, above what noise alone would show.
double sweep_speed(std::span<const LogSurvey> logs, const PartFilter& wanted, Channel channel,
                   double noise) {
  std::vector<double> speeds;
  for (const PilotWindow& p : pilot_windows(logs, wanted, {}, 0, kSettingsWindows)) {
    const int k = logs[p.log].plan.find(channel);
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

// The filter blurs a reversal over about 1/(2 pi cut-off): slower than the speed gained in that
// time the sign of the velocity is not known, however good the encoder.
double rest_speed(std::span<const LogSurvey> logs, const PartFilter& wanted,
                  const RowSettings& rows, PilotMotion& motion, Channel channel, double rate) {
  const double band = rows.signal.cutoff > 0 ? rows.signal.cutoff : rate / 2;
  const double noise = velocity_noise(worst_noise(logs, wanted, channel), band, rate);
  const double blur = motion.acceleration(rows.signal, channel) / (2 * kPi * band);
  return std::max(4 * noise, blur);
}

void choose_rest_speed(ChosenSettings& chosen, std::span<const LogSurvey> logs,
                       const PartFilter& wanted, const SampleOptions& options, PilotMotion& motion,
                       double rate) {
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
           "speed gained within the filter's blur, at least 4 sd of the speed's noise");
  }
  if (chosen.rest_speed_theta > 0 && rows.signal.cutoff > 0)
    rows.rest_margin = static_cast<Eigen::Index>(std::ceil(rate / (4 * rows.signal.cutoff)));
}

// Lowers the cut-off until position noise is a negligible part of the acceleration: noise in a
// regressor shrinks its coefficient by that share (errors in variables).
double quiet_cutoff(std::span<const LogSurvey> logs, const PartFilter& wanted,
                    const RowSettings& rows, PilotMotion& motion, Channel channel, double cutoff,
                    double rate) {
  const double noise = worst_noise(logs, wanted, channel);
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
                        const PartFilter& wanted, const SampleOptions& options, PilotMotion& motion,
                        double rate) {
  chosen.cutoff_q = chosen.rows.signal.cutoff;
  if (options.cutoff || !first_log_with(logs, wanted).plan.has(Channel::q)) return;
  chosen.cutoff_q =
      quiet_cutoff(logs, wanted, chosen.rows, motion, Channel::q, chosen.cutoff_q, rate);
  chosen.rows.lowest_cutoff = chosen.cutoff_q;
  if (chosen.cutoff_q < chosen.rows.signal.cutoff)
    decide(chosen, "cut-off of the link equation", fmt::format("{:.4g} Hz", chosen.cutoff_q),
           fmt::format("noise of q below {:g} % of the acceleration's variance", 100 * kNoiseBias));
}

void choose_moving_cutoff(ChosenSettings& chosen, std::span<const LogSurvey> logs,
                          const PartFilter& wanted, const SampleOptions& options,
                          PilotMotion& motion, double resonance, double rate) {
  double& cutoff = chosen.rows.signal.cutoff;
  if (options.cutoff) {
    cutoff = *options.cutoff;
    decide(chosen, "cut-off", cutoff > 0 ? fmt::format("{:.4g} Hz", cutoff) : "none", kByOption);
  } else {
    const double wish = resonance > 0
                            ? std::min(kResonanceFactor * resonance, kMaxShareOfRate * rate)
                            : kRigidShareOfRate * rate;
    cutoff = quiet_cutoff(logs, wanted, chosen.rows, motion, Channel::theta, wish, rate);
    std::string reason =
        resonance > 0 && wish < kMaxShareOfRate * rate
            ? fmt::format("{:g} times the resonance f0 = {:.3g} Hz", kResonanceFactor, resonance)
            : fmt::format("{:g} of the sample rate", wish / rate);
    if (cutoff < wish)
      reason = fmt::format("position noise below {:g} % of the acceleration's variance",
                           100 * kNoiseBias);
    decide(chosen, "cut-off", fmt::format("{:.4g} Hz", cutoff), reason);
  }
  choose_link_cutoff(chosen, logs, wanted, options, motion, rate);
  if (resonance > 0 && cutoff > 0 && cutoff < 2 * resonance)
    chosen.warnings.push_back(fmt::format(
        "the cut-off of {:.4g} Hz is below twice the resonance f0 = {:.3g} Hz: J_motor will "
        "be wrong by percents; record at a higher rate or with a finer encoder",
        cutoff, resonance));
}

}  // namespace

double position_noise(const LogSurvey& log, const PartSurvey& part, Channel channel, int joint) {
  const int k = log.plan.find(channel, joint);
  if (k < 0) return 0;
  const auto sensor = log.plan.rig.sensors.find(std::string(channel_name(channel)));
  if (sensor != log.plan.rig.sensors.end()) {
    const double quantum = sensor->second.quantum.value_or(0) / std::sqrt(12.0);
    const double noise = sensor->second.noise.value_or(0);
    if (quantum > 0 || noise > 0) return std::hypot(quantum, noise);
  }
  const ChannelSurvey& c = part.channels[static_cast<std::size_t>(k)];
  return std::max(c.noise, c.quantum / std::sqrt(12.0));
}

double velocity_noise(double noise, double cutoff, double rate) {
  // Power of white noise is noise^2 over 0..rate/2; differentiation weighs it with (2 pi f)^2.
  return noise * 2 * kPi * std::sqrt(std::pow(cutoff, 3) / 3 * 2 / rate);
}

double acceleration_noise(double noise, double cutoff, double rate) {
  return noise * 4 * kPi * kPi * std::sqrt(std::pow(cutoff, 5) / 5 * 2 / rate);
}

namespace {

/// A sweep that repeats faster than a tenth of the cut-off is not quasi-static.
void warn_of_haste(std::span<const LogSurvey> logs, const PartFilter& wanted, double sweep,
                   double cutoff, ChosenSettings& chosen) {
  double range = 0;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts) {
      const int k = log.plan.find(Channel::theta);
      if (k >= 0 && wanted(part))
        range = std::max(range, part.channels[static_cast<std::size_t>(k)].range());
    }
  if (!(range > 0) || cutoff <= 0) return;
  const double frequency = sweep / (2 * range);  // up and down once: twice the range
  if (frequency > 0.1 * cutoff)
    chosen.warnings.push_back(fmt::format(
        "the motor sweeps about {:.2g} times a second: too fast for stage 1, inertia and the "
        "filter falsify stiffness and friction; sweep slower",
        frequency));
}

}  // namespace

ChosenSettings blocked_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                                const SampleOptions& options) {
  ChosenSettings chosen;
  const RateRange rates = sample_rates(logs, wanted);
  const double rate = rates.lowest;  // what the slowest log can carry, all others can
  if (rates.highest > kRateSpread * rates.lowest)
    chosen.warnings.push_back(fmt::format(
        "the logs have rates of {:.4g} to {:.4g} Hz: the slowest bounds the filter for all",
        rates.lowest, rates.highest));
  check_options(logs, wanted, options, rate);
  choose_filter_order(chosen, options);
  const double noise = worst_noise(logs, wanted, Channel::theta);
  const double sweep = sweep_speed(logs, wanted, Channel::theta, noise);
  double& cutoff = chosen.rows.signal.cutoff;
  if (options.cutoff) {
    cutoff = *options.cutoff;
    decide(chosen, "cut-off", cutoff > 0 ? fmt::format("{:.4g} Hz", cutoff) : "none", kByOption);
  } else {
    cutoff = std::min(kBlockedCutoff, kMaxShareOfRate * rate);
    decide(chosen, "cut-off", fmt::format("{:.4g} Hz", cutoff), "quasi-static");
  }
  choose_decimation(chosen, options, rate);
  choose_edges(chosen, options, rates.highest);
  const double band = cutoff > 0 ? cutoff : rate / 2;
  const double unseen = 4 * velocity_noise(noise, band, rate);
  const double noise_q = worst_noise(logs, wanted, Channel::q);
  chosen.rest_speed_q = std::max(4 * velocity_noise(noise_q, band, rate),
                                 kStillShare * sweep_speed(logs, wanted, Channel::q, noise_q));
  if (cutoff > 0)
    chosen.rows.rest_margin = static_cast<Eigen::Index>(std::ceil(rate / (2 * cutoff)));
  if (options.rest_speed) {
    chosen.rest_speed_theta = *options.rest_speed;
    decide(chosen, "rest speed", fmt::format("{:.3g}", chosen.rest_speed_theta), kByOption);
  } else if (unseen > kSlowShare * sweep) {
    // Too slow for the encoder to tell motion from rest row by row: the direction of the last
    // motion is all there is, and it is enough for the branch.
    chosen.rest_speed_theta = 0;
    decide(chosen, "rest speed", "0",
           fmt::format("a sweep of {:.2g} rad/s does not stand out of the speed's noise; rows go "
                       "by the direction of "
                       "the last motion",
                       sweep));
  } else {
    chosen.rest_speed_theta = std::max(unseen, kRestShare * sweep);
    decide(
        chosen, "rest speed", fmt::format("{:.3g}", chosen.rest_speed_theta),
        fmt::format("{:g} of the sweep's speed, at least 4 sd of the speed's noise", kRestShare));
  }
  const Rig& rig = first_log_with(logs, wanted).plan.rig;
  // A delay looks like viscous friction, which stage 1 estimates anyway: auto need not decide.
  chosen.rows.signal.torque_held = options.torque_hold.value_or(rig.torque_hold) == TorqueHold::zoh;
  chosen.rows.signal.torque_period = rig.torque_period;
  chosen.rows.signal.quasi_static = true;
  warn_of_haste(logs, wanted, sweep, cutoff, chosen);
  return chosen;
}

ChosenSettings moving_settings(std::span<const LogSurvey> logs, const PartFilter& wanted,
                               const SampleOptions& options, double resonance) {
  ChosenSettings chosen;
  const RateRange rates = sample_rates(logs, wanted);
  const double rate = rates.lowest;  // what the slowest log can carry, all others can
  if (rates.highest > kRateSpread * rates.lowest)
    chosen.warnings.push_back(fmt::format(
        "the logs have rates of {:.4g} to {:.4g} Hz: the slowest bounds the filter for all",
        rates.lowest, rates.highest));
  check_options(logs, wanted, options, rate);
  choose_filter_order(chosen, options);
  PilotMotion motion(logs, wanted);
  choose_moving_cutoff(chosen, logs, wanted, options, motion, resonance, rate);
  choose_decimation(chosen, options, rate);
  choose_edges(chosen, options, rates.highest);
  choose_rest_speed(chosen, logs, wanted, options, motion, rate);
  return chosen;
}

}  // namespace cablefit
