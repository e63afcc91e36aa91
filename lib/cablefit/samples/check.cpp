#include "cablefit/samples/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cablefit/base/quote.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/signals.hpp"
#include "cablefit/samples/survey/speed_histogram.hpp"

namespace cablefit {
namespace {

constexpr double kMostlyAtRest = 0.8;
constexpr double kFewSteps = 100;  // a position that spans fewer encoder steps

std::string usual_unit(Channel channel, Axes axes) {
  const bool is_torque = channel == Channel::tau || channel == Channel::tau_load;
  if (is_torque) return torque_unit(axes);
  if (channel == Channel::w) return unit_for(axes, "rad/s");
  return unit_for(axes, "rad");
}

/// "theta", or "theta2" of several joints.
std::string indexed_name(Channel channel, int joint, const Rig& rig) {
  std::string name(channel_name(channel));
  if (rig.n_joints() > 1) name += std::to_string(joint + 1);
  return name;
}

std::vector<CheckedChannel> channels_of(const LogSurvey& log, const PartSurvey& part) {
  std::vector<CheckedChannel> channels;
  const Rig& rig = log.plan.rig;
  for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
    const Slot& slot = log.plan.slots[k];
    if (slot.integrated) continue;
    const std::string name = indexed_name(slot.channel, slot.joint, rig);
    const std::string unit = usual_unit(slot.channel, rig.axes.of(slot.joint));
    channels.push_back({name, unit, unit == "rad", part.channels[k]});
  }
  return channels;
}

/// The channel that shows best how one joint moves.
std::optional<Channel> motion_channel(const LogPlan& plan, int joint) {
  std::optional<Channel> best;
  for (const Channel channel : {Channel::q, Channel::w, Channel::theta}) {
    if (plan.has_measured(channel, joint)) best = channel;
  }
  return best;
}

const Eigen::ArrayXd& speed_of(const JointSignals& signals, Channel channel) {
  return channel == Channel::q ? signals.qd : signals.thetad;
}

CheckedExcitation excitation_of(const LogSurvey& log, const PartSurvey& part,
                                const SampleOptions& options, int joint) {
  CheckedExcitation excitation;
  const std::optional<Channel> channel = motion_channel(log.plan, joint);
  if (!channel) return excitation;
  excitation.channel = indexed_name(*channel, joint, log.plan.rig);
  const PartFilter wanted = [&part](const PartSurvey& other) {
    return other.preload == part.preload && other.run == part.run && other.phase == part.phase &&
           other.t_first == part.t_first;
  };
  const std::span<const LogSurvey> one(&log, 1);
  const ChosenSettings chosen = part.phase == Phase::blocked
                                    ? blocked_settings(one, wanted, options, joint)
                                    : moving_settings(one, wanted, options, 0, joint);
  const SignalSettings& settings = chosen.rows.signal;
  excitation.rest_speed = *channel == Channel::q ? chosen.rest_speed_q : chosen.rest_speed_theta;
  SpeedHistogram histogram;
  double n = 0, n_at_rest = 0;
  for_each_window(log, wanted, signal_halo(settings, 1 / part.period), 2 * kDifferenceEdge + 2,
                  bridge_seconds(settings), [&](Window&& window) {
                    const Signals signals = make_signals(window, log.plan, settings);
                    const Eigen::ArrayXd& speed =
                        speed_of(signals.joints[static_cast<std::size_t>(joint)], *channel);
                    for (Eigen::Index i = window.begin; i < window.end; ++i) {
                      const double v = std::abs(speed(i - window.first));
                      n += 1;
                      if (v <= excitation.rest_speed) n_at_rest += 1;
                      if (v > excitation.rest_speed) histogram.add(v);
                    }
                    return true;
                  });
  excitation.share_at_rest = n > 0 ? n_at_rest / n : 0;
  excitation.fastest = histogram.fastest();
  excitation.speed_bands = histogram.fastest() > 0 ? histogram.bands() : 0;
  return excitation;
}

/// Of several joints the one that moves least: what it lacks, the log lacks.
CheckedExcitation least_excitation(const LogSurvey& log, const PartSurvey& part,
                                   const SampleOptions& options) {
  CheckedExcitation least = excitation_of(log, part, options, 0);
  for (int joint = 1; joint < log.plan.rig.n_joints(); ++joint) {
    CheckedExcitation other = excitation_of(log, part, options, joint);
    const bool rests_more = other.share_at_rest > least.share_at_rest;
    if (least.channel.empty() || (!other.channel.empty() && rests_more)) least = std::move(other);
  }
  return least;
}

/// Whether every joint has these channels, and moves by the first of them.
bool all_joints_move(const LogPlan& plan, const PartSurvey& part,
                     std::initializer_list<Channel> channels) {
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint) {
    for (const Channel channel : channels)
      if (!plan.has(channel, joint)) return false;
    const auto k = static_cast<std::size_t>(plan.find(*channels.begin(), joint));
    if (!(part.channels[k].range() > 0)) return false;
  }
  return true;
}

/// What several joints are good for: every joint needs every channel.
std::vector<std::string> identified_by_joints(const LogPlan& plan, const PartSurvey& part) {
  using enum Channel;
  if (part.phase == Phase::blocked)
    return all_joints_move(plan, part, {theta, q, tau}) ? std::vector<std::string>{"elastic"}
                                                        : std::vector<std::string>{};
  std::vector<std::string> models;
  if (all_joints_move(plan, part, {q, theta, tau})) models.emplace_back("dynamic");
  if (all_joints_move(plan, part, {theta, tau})) models.emplace_back("rigid");
  return models;
}

std::vector<std::string> identified_by(const LogPlan& plan, const PartSurvey& part) {
  if (plan.rig.n_joints() > 1) return identified_by_joints(plan, part);
  const bool q = plan.has(Channel::q), theta = plan.has(Channel::theta);
  const bool tau = plan.has(Channel::tau);
  const auto moves = [&](Channel channel) {
    const int k = plan.find(channel);
    return k >= 0 && part.channels[static_cast<std::size_t>(k)].range() > 0;
  };
  const bool drive_moves = moves(Channel::theta);
  if (part.phase == Phase::blocked) {
    return q && tau && drive_moves ? std::vector<std::string>{"elastic"}
                                   : std::vector<std::string>{};
  }
  if (q && theta && tau && moves(Channel::q) && drive_moves) return {"dynamic", "rigid"};
  if (tau && drive_moves) return {"rigid"};
  if (q && theta && moves(Channel::q)) return {"ratios"};
  return {};
}

void note_channels(CheckedPart& part) {
  for (const CheckedChannel& channel : part.channels) {
    const ChannelSurvey& s = channel.survey;
    if (channel.is_angle && s.quantum > 0 && s.range() < kFewSteps * s.quantum) {
      if (part.survey.phase == Phase::blocked && channel.name.front() == 'q') continue;
      part.warnings.push_back(fmt::format("{} spans only {:.0f} steps of its encoder", channel.name,
                                          s.range() / s.quantum));
    }
  }
}

/// What a log lacks of which nothing can be identified, and what would help.
std::string why_nothing(const LogPlan& plan) {
  const bool q = plan.has(Channel::q), theta = plan.has(Channel::theta);
  const bool tau = plan.has(Channel::tau);
  if (!tau && q && theta && plan.rig.n_joints() > 1)
    return "q and theta without tau: of several joints nothing can be identified; a rig file of "
           "one "
           "joint with its columns gives ratios to J_link, stiffness and friction need tau";
  if (!tau)
    return fmt::format(
        "{} without tau: the torque is missing, so inertia and friction are not "
        "identifiable; log the drive's torque or current",
        q && theta             ? "q and theta"
        : q                    ? "q"
        : plan.has(Channel::w) ? "w"
                               : "theta");
  if (!theta && !q && !plan.has(Channel::w))
    return "tau without a position or a speed; log theta or w";
  return "nothing can be identified from this part: stage 1 needs q, theta and tau with the link "
         "blocked; stage 2 the same with the link moving; a rigid drive theta or w, and tau";
}

void note_motion(const LogPlan& plan, bool trusted, CheckedPart& part) {
  const auto warn = [&part](const std::string& text) { part.warnings.push_back(text); };
  const CheckedExcitation& e = part.excitation;
  if (part.identifies.empty()) warn(why_nothing(plan));
  if (plan.q_is_theta) warn("q is the only position: it is read as theta, that of a rigid drive");
  if (part.survey.uneven)
    warn("the sample times are uneven: rows will be resampled on an even grid");
  if (part.survey.phase == Phase::blocked || e.channel.empty()) return;
  if (e.share_at_rest > kMostlyAtRest && !trusted) {
    warn(fmt::format("the drive rests in {:.0f} % of the rows", 100 * e.share_at_rest));
  }
  if (e.speed_bands == 1 && !trusted) {
    warn("one speed only: viscous and Coulomb friction are not separable");
  }
  const bool has_load = plan.has(Channel::tau_load) || plan.rig.load.law != nullptr;
  if (!part.identifies.empty() && part.identifies.front() == "dynamic" && !has_load) {
    warn(
        "no tau_load column and no load law in the rig file: the load will be taken as 0; "
        "give one as \"load\" in the rig file, {\"type\": \"none\"} where there is none");
  }
}

CheckedPart check_part(const LogSurvey& log, const PartSurvey& survey,
                       const SampleOptions& options) {
  CheckedPart part;
  part.survey = survey;
  part.channels = channels_of(log, survey);
  part.excitation = least_excitation(log, survey, options);
  part.identifies = identified_by(log.plan, survey);
  const bool trusted = has_trusted_finding({&log, 1}, [](const PartSurvey&) { return true; });
  if (!trusted) note_channels(part);
  note_motion(log.plan, trusted, part);
  return part;
}

bool has_known_load(const LogSurvey& log) {
  const auto& [law, parameters] = log.plan.rig.load;
  if (law != nullptr && !law->from_column)  // 0 at one angle only: a pendulum
    return law->torque(parameters, 0) != 0 || law->torque(parameters, 1) != 0;
  return std::any_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& part) {
    for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
      const ChannelSurvey& channel = part.channels[k];
      if (log.plan.slots[k].channel == Channel::tau_load && (channel.min != 0 || channel.max != 0))
        return true;
    }
    return false;
  });
}

/// A wrong torque constant scales every stiffness, inertia and friction. Only a known load shows
/// it.
void note_unchecked_scale(std::span<const LogSurvey> logs, std::vector<std::string>& warnings) {
  if (std::any_of(logs.begin(), logs.end(), has_known_load)) return;
  for (const LogSurvey& log : logs)
    for (const auto& [channel, mapping] : log.plan.rig.columns) {
      const bool is_torque = channel == "tau" || channel == "tau1";
      if (!is_torque || std::abs(mapping.scale) == 1) continue;
      warnings.push_back(fmt::format(
          "{} is {:g} times column {}, and no log has a known load to check this factor: if it "
          "is "
          "wrong, so are all stiffnesses, inertias and frictions; record a log with a known load",
          channel, mapping.scale, in_quotes(mapping.column)));
      return;
    }
}

std::vector<std::string> unused_columns(const LogPlan& plan) {
  std::vector<std::string> unused;
  for (std::size_t k = 0; k < plan.header.columns.size(); ++k) {
    const bool is_slot = std::any_of(plan.slots.begin(), plan.slots.end(),
                                     [k](const Slot& slot) { return slot.column == k; });
    const bool is_other = plan.time_column == k || plan.preload_column == k ||
                          plan.phase_column == k || plan.run_column == k;
    if (!is_slot && !is_other) unused.push_back(plan.header.columns[k].name);
  }
  return unused;
}

}  // namespace

bool CheckedLog::usable() const {
  return std::any_of(parts.begin(), parts.end(),
                     [](const CheckedPart& part) { return !part.identifies.empty(); });
}

CheckResult check_logs(std::span<const LogSurvey> logs, const SampleOptions& options) {
  CheckResult result;
  result.warnings = input_warnings(logs);
  note_unchecked_scale(logs, result.warnings);
  for (const LogSurvey& log : logs) {
    CheckedLog checked{log.plan.path,
                       log.sha256,
                       log.plan.rig.path,
                       log.n_rows,
                       log.plan.rig.axes.all(),
                       unused_columns(log.plan),
                       {}};
    checked.decisions = log.plan.decisions;
    for (const PartSurvey& part : log.parts) {
      checked.parts.push_back(check_part(log, part, options));
    }
    result.logs.push_back(std::move(checked));
  }
  return result;
}

}  // namespace cablefit
