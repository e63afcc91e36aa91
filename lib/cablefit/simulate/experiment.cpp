#include "cablefit/simulate/experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "cablefit/base/error.hpp"
#include "cablefit/simulate/arm_step.hpp"

namespace cablefit {
namespace {

std::string kind_of(const Rig& rig) {
  return fmt::format("{} {} joint{}", rig.n_joints(), to_string(rig.axes.all()),
                     rig.n_joints() == 1 ? "" : "s");
}

/// A rig file that gives another arm than the model's is of another bench.
void require_arm_of(const Model& model, const Rig& rig) {
  if (!model.is_coupled() || rig.arm.kind == nullptr) return;
  const std::vector<ParameterInfo> infos = rig.arm.base_parameters();
  const bool is_same =
      std::equal(infos.begin(), infos.end(), model.arm.begin(), model.arm.end(),
                 [](const ParameterInfo& info, const Estimate& e) { return info.name == e.name; });
  if (!is_same)
    throw input_error({rig.path}, "the arm has other base parameters than the model's",
                      "simulate logs of the arm that the model is of");
}

void require_in_every_joint(const LogPlan& plan, Channel channel, std::string_view why) {
  if (!plan.has_for_all(channel)) require_channel(plan, channel, why);
}

void choose_mode(const LogPlan& plan, const ReplayOptions& options, Experiment& experiment) {
  const std::string obstacle = no_closed_loop(plan);
  const bool given = options.mode != ReplayMode::automatic;
  if (options.mode == ReplayMode::closed_loop && !obstacle.empty()) {
    throw input_error({plan.path}, obstacle,
                      plan.rig.open_loop
                          ? "replay the torque"
                          : "a closed loop needs a controller in the rig file and its reference in "
                            "the log; or replay the torque");
  }
  experiment.simulation.closed_loop = options.mode != ReplayMode::torque && obstacle.empty();
  if (experiment.simulation.closed_loop) {
    experiment.decisions.push_back(
        {"mode", "closed loop",
         given ? "given" : "the rig's controller, its reference in the log"});
  } else {
    experiment.decisions.push_back({"mode", "torque replay", given ? "given" : obstacle});
  }
}

void choose_hold(const Rig& rig, const ReplayOptions& options, Experiment& experiment) {
  if (experiment.simulation.closed_loop) return;
  const bool given = options.torque_hold && *options.torque_hold != TorqueHold::automatic;
  const TorqueHold hold = given ? *options.torque_hold : rig.torque_hold;
  experiment.simulation.hold_torque = hold != TorqueHold::none;
  experiment.decisions.push_back({"torque hold", hold == TorqueHold::none ? "none" : "zoh",
                                  given ? "given"
                                  : hold == TorqueHold::automatic
                                      ? "default; use --torque-hold none for a measured current"
                                      : "by the rig file, or by the fit of the model"});
}

void choose_window(const ReplayOptions& options, Experiment& experiment) {
  const bool closed_loop = experiment.simulation.closed_loop;
  experiment.window_seconds = options.window.value_or(closed_loop ? 0.0 : kReplayWindowSeconds);
  const bool restarts = experiment.window_seconds > 0;
  experiment.decisions.push_back(
      {"window", restarts ? fmt::format("{:g} s", experiment.window_seconds) : "whole stretches",
       options.window ? "given"
       : closed_loop  ? "the controller keeps the drive on its reference"
                      : "restarted from the measured state: the noise of a replayed torque makes "
                        "positions drift"});
}

/// Independent joints keep theirs: they are fast.
void choose_step(const ReplayOptions& options, Experiment& experiment) {
  if (options.step) experiment.simulation.step = *options.step;
  if (options.step || !experiment.model.is_coupled()) return;
  const double mode = stiffest_mode(experiment.model);
  experiment.simulation.step = arm_step(mode);
  experiment.decisions.push_back(
      {"step", fmt::format("{:.3g} us", 1e6 * experiment.simulation.step),
       fmt::format("of links that move each other: stiffest mode {:.3g} Hz; --step gives another",
                   mode / (2 * std::numbers::pi))});
}

void add_refinements(const Model& model, Experiment& experiment) {
  std::string names;
  for (std::size_t k = 0; k < model.joints.size(); ++k)
    for (const EffectInstance& instance : model.joints[k].added) {
      const Effect& row = *instance.effect;
      if (!names.empty()) names += ", ";
      names += fmt::format("{} ({})", row.name, to_string(row.site));
      if (model.joints.size() > 1) names += fmt::format(" of joint {}", model.rig.joints[k]);
    }
  if (!names.empty()) experiment.decisions.push_back({"refinements", names, "of the model"});
}

void require_channels(const Model& model, const LogPlan& plan, const PartSurvey& part,
                      Experiment& experiment) {
  require_in_every_joint(plan, Channel::theta, "the initial state of a simulation");
  if (!model.rigid) require_in_every_joint(plan, Channel::q, "the initial state of a simulation");
  if (!experiment.simulation.closed_loop) {
    require_in_every_joint(plan, Channel::tau, "replaying the torque");
  }
  if (experiment.simulation.link_blocked) return;
  const LoadLaw* law = experiment.model.rig.load.law;
  const bool by_column = law && law->from_column;
  if (by_column) {
    require_in_every_joint(plan, Channel::tau_load, "the load that the rig file says is a column");
  } else if (!law && !model.rigid && !plan.has_for_all(Channel::tau_load)) {
    experiment.warnings.emplace_back(
        "no tau_load column and no load law in the rig file: the load torque is taken as 0; "
        "give one as \"load\" in the rig file, {\"type\": \"none\"} where there is none");
  }
  (void)part;
}

}  // namespace

std::string no_closed_loop(const LogPlan& plan) {
  if (plan.rig.open_loop) return "the rig file says that the torque is a command";
  if (!plan.rig.controller) return "no controller in the rig file";
  return missing_reference(plan);
}

bool is_of_model(const Model& model, const PartSurvey& part) {
  return model.preload.empty() || part.preload == model.preload;
}

Rig rig_for_simulation(const std::string& log_path, const std::string& rig_option,
                       const Model& model) {
  Rig rig = rig_for_log(log_path, rig_option);
  if (rig.path.empty()) return model.rig;
  if (kind_of(rig) != kind_of(model.rig)) {
    throw input_error({rig.path},
                      fmt::format("{}, the model has {}", kind_of(rig), kind_of(model.rig)),
                      "simulate logs of the bench that the model is of");
  }
  require_arm_of(model, rig);
  if (rig.arm.kind == nullptr) rig.arm = model.rig.arm;
  if (!rig.load.law) rig.load = model.rig.load;
  if (!rig.controller && !rig.open_loop) {
    rig.controller = model.rig.controller;
    rig.open_loop = model.rig.open_loop;
  }
  if (rig.sensors.empty()) rig.sensors = model.rig.sensors;
  if (rig.torque_hold == TorqueHold::automatic) rig.torque_hold = model.rig.torque_hold;
  return rig;
}

LogSurvey survey_for_simulation(const std::string& log_path, const std::string& rig_option,
                                const Model& model, const Reading& reading) {
  const Rig rig = rig_for_simulation(log_path, rig_option, model);
  return survey_log(plan_log(log_path, rig, reading),
                    rig.preload.empty() ? model.preload : rig.preload);
}

Experiment plan_experiment(const Model& model, const LogSurvey& log, const PartSurvey& part,
                           const ReplayOptions& options) {
  Experiment experiment;
  experiment.model = model;
  experiment.model.rig = log.plan.rig;
  experiment.model.rig.arm = model.rig.arm;  // what the base parameters are of
  experiment.simulation.link_blocked = part.phase == Phase::blocked;
  choose_mode(log.plan, options, experiment);
  choose_hold(log.plan.rig, options, experiment);
  choose_window(options, experiment);
  choose_step(options, experiment);
  if (options.compared < 1)
    experiment.compared_from = part.t_last - options.compared * (part.t_last - part.t_first);
  add_refinements(model, experiment);
  require_channels(model, log.plan, part, experiment);
  return experiment;
}

}  // namespace cablefit
