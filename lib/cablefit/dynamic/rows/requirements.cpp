#include "cablefit/dynamic/rows/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr double kHiddenShare = 1.0 / 3;  // of the motion's speed, that its error must stay below
constexpr double kMotionCutoff = 10;      // Hz; hides neither a joint's motion nor shows its noise
constexpr double kFastMotion = 0.9;       // quantile; leaves out what a jump of an encoder does
constexpr double kMovingQuantile = 0.8;   // a fifth of the samples is faster than the rest speed
constexpr double kSlowRate = 250;         // Hz

const char* const kRecordMore = "record a longer or faster motion, or lower --rest-speed";

/// Hardly any noise is left at this cut-off.
SignalSettings calm_settings(double rate) {
  SignalSettings settings;
  settings.cutoff = std::min(kMotionCutoff, 0.1 * rate);
  settings.filter_order = 2;
  return settings;
}

/// Magnitudes of the speed by which rest is judged, of the first windows.
std::vector<double> calm_speeds(const DynamicJob& job, const Equation& equation,
                                const RateRange& rates) {
  const SignalSettings settings = calm_settings(rates.lowest);
  std::vector<double> speeds;
  for (const PreliminaryWindow& p :
       preliminary_windows(job.logs, job.wanted, settings, signal_halo(settings, rates.highest),
                           kSettingsWindows)) {
    const Signals signals = make_signals(p.window, job.logs[p.log].plan, settings);
    const Eigen::ArrayXd speed = equation.speed(signals).abs();
    const Eigen::Index from = p.window.begin - p.window.first;
    const Eigen::Index to = std::min(p.window.end - p.window.first, speed.size());
    for (Eigen::Index i = from; i < to; ++i) speeds.push_back(speed(i));
  }
  std::sort(speeds.begin(), speeds.end());
  return speeds;
}

double at_quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

std::string rate_too_low(double rate) {
  return rate > kSlowRate ? "" : fmt::format(", or too low a rate ({:.4g} Hz)", rate);
}

/// The error of the speed is as large as the motion; empty: it is not.
std::string hidden_motion(const DynamicJob& job, const Equation& equation, double speed,
                          double rate) {
  const double error = equation.rest_speed;
  if (!(speed > 0) || error <= kHiddenShare * speed) return "";
  const std::string unit = unit_for(job.rig().axes.all(), "rad/s");
  return fmt::format(
      "the speed's error on the {} side ({:.2g} {}) hides the motion ({:.2g} {}): encoder jumps{}, "
      "or too slow a motion; look at the positions, or set --rest-speed",
      equation.name, error, unit, speed, unit, rate_too_low(rate));
}

/// Whose noise has lowered a cut-off.
std::optional<Channel> noisy_channel(const ChosenSettings& settings) {
  for (const Decision& decision : settings.decisions) {
    if (decision.reason.find("noise") == std::string::npos) continue;
    if (decision.name == "cut-off") return Channel::theta;
    if (decision.name == "cut-off of the link equation") return Channel::q;
  }
  return std::nullopt;
}

/// Noise has lowered the cut-off so far that a period of it around every reversal leaves no motion;
/// empty: it has not.
std::string lowered_cutoff(const DynamicJob& job, const EquationRows& e, double rate) {
  const int joint = e.columns.place.joint;
  const ChosenSettings& settings = job.settings_of(joint);
  const std::optional<Channel> channel = noisy_channel(settings);
  if (!channel) return "";
  double noise = 0;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part)) noise = std::max(noise, position_noise(log, part, *channel, joint));
  return fmt::format(
      "the noise of {} ({:.2g} {}) lowers the cut-off to {:.2g} Hz, too low for the motion on the "
      "{} side: encoder jumps{}; look at the positions, or set --cutoff",
      channel_name(*channel), noise, unit_for(job.rig().axes.of(joint), "rad"),
      *channel == Channel::q ? settings.cutoff_q : settings.rows.signal.cutoff, e.equation.name,
      rate_too_low(rate));
}

/// What hides a motion that is there; empty: nothing does, or the user has chosen the rest speed.
std::string hiding_cause(const DynamicJob& job, const EquationRows& e) {
  const Equation& equation = e.equation;
  if (job.options.samples.rest_speed || !(equation.rest_speed > 0) || !equation.speed) return "";
  const RateRange rates = sample_rates(job.logs, job.wanted);
  const std::vector<double> speeds = calm_speeds(job, equation, rates);
  std::string hidden = hidden_motion(job, equation, at_quantile(speeds, kFastMotion), rates.lowest);
  if (!hidden.empty()) return hidden;
  const bool moves = at_quantile(speeds, kMovingQuantile) > equation.rest_speed;
  return moves ? lowered_cutoff(job, e, rates.lowest) : "";
}

bool torque_changes(const DynamicJob& job, int joint) {
  for (const LogSurvey& log : job.logs) {
    const int k = log.plan.find(Channel::tau, joint);
    for (const PartSurvey& part : log.parts)
      if (k >= 0 && job.wanted(part) && part.channels[static_cast<std::size_t>(k)].range() > 0)
        return true;
  }
  return false;
}

/// The most that a position moves in any part, and the most that its noise alone would.
struct Travel {
  double most = 0, of_noise = 0;
};

/// None: no such channel.
std::optional<Travel> travel_of(const DynamicJob& job, Channel channel, int joint) {
  std::optional<Travel> travel;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts) {
      const int k = log.plan.find(channel, joint);
      if (k < 0 || !job.wanted(part)) continue;
      // The expected range of n normal numbers is below 2 sqrt(2 ln n) sd (Gumbel 1958).
      const double n = std::max(2.0, static_cast<double>(part.n_rows));
      const double in_sd = 2 * std::sqrt(2 * std::log(n)) + 1;
      if (!travel) travel = Travel{};
      travel->most = std::max(travel->most, part.channels[static_cast<std::size_t>(k)].range());
      travel->of_noise =
          std::max(travel->of_noise, in_sd * position_noise(log, part, channel, joint));
    }
  return travel;
}

/// "q2 moves 1e-05 rad, theta2 3e-05 rad", where neither position of the joint moves beyond its
/// noise; empty: it moves.
std::string stillness_of(const DynamicJob& job, int joint) {
  std::string text;
  for (const Channel channel : {Channel::q, Channel::theta}) {
    const std::optional<Travel> travel = travel_of(job, channel, joint);
    if (!travel) continue;
    if (travel->most > travel->of_noise) return "";
    text += fmt::format("{}{}{} {}{:.2g} {}", text.empty() ? "" : ", ", channel_name(channel),
                        joint + 1, text.empty() ? "moves " : "", travel->most,
                        unit_for(job.rig().axes.of(joint), "rad"));
  }
  return text;
}

void require_restoring(const ElasticFit& fit, const std::string& preload) {
  if (is_linear(fit) && !(fit.transmission.linear_stiffness.minCoeff() > 0))
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format("stage 1 of preload '{:.40}' has a negative stiffness: the sign of tau, theta "
                    "or q is reversed; correct it in the rig file and run 'cablefit elastic' again",
                    preload));
}

const ElasticFit& find_stage1(const ElasticResult& elastic, const std::string& preload,
                              const std::string& model) {
  for (const ElasticPreload& p : elastic.preloads) {
    if (p.name != preload) continue;
    if (const ElasticFit* fit = p.find(model)) return *fit;
    throw Error(ErrorKind::input, fmt::format("stage 1 has no '{}' fit for preload '{:.40}'; run "
                                              "'cablefit elastic' again",
                                              model, preload));
  }
  std::string names;
  for (const ElasticPreload& p : elastic.preloads) names += (names.empty() ? "" : ", ") + p.name;
  throw Error(
      ErrorKind::input,
      fmt::format("stage 1 has no preload '{:.40}' for the moving logs; it has {}; run "
                  "'cablefit elastic' on a blocked log of that preload, or use the same preload "
                  "names",
                  preload, names.empty() ? "none" : names));
}

}  // namespace

void require_channels(const LogPlan& plan, bool rigid) {
  require_channel(plan, Channel::tau, rigid ? "the rigid model" : "stage 2");
  if (rigid) {
    require_channel(plan, Channel::theta, "the rigid model");
    return;
  }
  require_channel(plan, Channel::q, "an elastic model",
                  "add it, map it in a rig file, or use --model rigid");
  require_channel(plan, Channel::theta, "an elastic model");
}

void require_torque(const DynamicJob& job) {
  const int n = job.n_joints();
  for (int joint = 0; joint < n; ++joint)
    if (!torque_changes(job, joint))
      throw input_error({job.first_log().plan.path, 0, 0},
                        fmt::format("tau{} never changes", n > 1 ? std::to_string(joint + 1) : ""),
                        "check which column holds the torque");
}

void require_motion(const DynamicJob& job) {
  const int n = job.n_joints();
  for (int joint = 0; n > 1 && joint < n; ++joint)
    if (const std::string still = stillness_of(job, joint); !still.empty())
      throw Error(
          ErrorKind::not_identifiable,
          fmt::format("preload '{:.40}': joint {} stands still: {}, within the noise of the "
                      "encoders; record a log in which joint {} moves too",
                      job.preload, joint + 1, still, joint + 1));
}

std::string too_few_rows(const DynamicJob& job, const EquationRows& e, std::size_t n_rows,
                         const std::string& remedy) {
  if (std::string cause = hiding_cause(job, e); !cause.empty()) return cause;
  return fmt::format("only {} rows in motion on the {} side{}{}", n_rows, e.equation.name,
                     remedy.empty() ? "" : "; ", remedy);
}

void require_rows(const EquationRows& e, const DynamicJob& job) {
  if (e.counts.rows_used >= static_cast<std::size_t>(kRowsPerParameter * e.columns.n_effects))
    return;
  throw Error(ErrorKind::not_identifiable,
              fmt::format("preload '{}': {}", job.preload,
                          too_few_rows(job, e, e.counts.rows_used, kRecordMore)));
}

const ElasticFit& require_stage1(const ElasticResult& elastic, const std::string& preload,
                                 const std::string& model) {
  const ElasticFit& fit = find_stage1(elastic, preload, model);
  require_restoring(fit, preload);
  return fit;
}

}  // namespace cablefit
