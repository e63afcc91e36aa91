#include "cablefit/dynamic/loops/noise_free_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "cablefit/base/parallel.hpp"
#include "cablefit/dynamic/loops/log_copy.hpp"
#include "cablefit/model/joint_inertias.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/butterworth.hpp"
#include "cablefit/samples/survey/noise.hpp"
#include "cablefit/simulate/simulator.hpp"
#include "cablefit/simulate/start_state.hpp"

namespace cablefit {
namespace {

constexpr double kLoopStep = 200e-6;  // s
// Of the regression's cut-off: acceleration noise goes with bandwidth^2.5, so that 1/32 of its
// variance is left in the instruments.
constexpr double kSurrogateShare = 0.5;
constexpr double kUnfilteredShare = 0.05;  // of the rate, where the regression has no cut-off
constexpr int kSurrogateOrder = 4;
constexpr double kDamping = 0.7;
constexpr double kLargestGain = 0.5;  // of kd h / J_motor, which is unstable from about 1 on

std::string no_known_loop(const LogPlan& plan) {
  if (plan.rig.open_loop) return "some logs in open loop, others not";
  if (!plan.rig.controller) return "no controller in the rig file";
  return missing_reference(plan);
}

/// Follows its reference within the bandwidth, whatever inertia swings along; damped for the motor
/// alone, which is what it turns above the resonance.
Controller surrogate(const JointInertias& inertias, double bandwidth, double h) {
  const auto [motor, total] = inertias;
  const double omega = 2 * std::numbers::pi * bandwidth;
  Controller c;
  c.kd = std::min(2 * kDamping * total * omega, kLargestGain * motor / h);
  c.kp = std::min(total * omega * omega, c.kd * c.kd / (4 * kDamping * kDamping * motor));
  c.period = h;
  return c;
}

Channel input_channel(LoopKind kind) {
  return kind == LoopKind::known     ? Channel::theta_ref
         : kind == LoopKind::command ? Channel::tau
                                     : Channel::theta;
}

/// One log beside its noise-free loop, window by window.
class LogLoop {
 public:
  LogLoop(const LogSurvey& log, const Model& model, const LoopPlan& plan, bool torque_held,
          double step)
      : log_(log), model_(model), plan_(plan), copy_(log, true) {
    model_.rig.sensors.clear();  // no quantisation in the loop either
    if (plan.fitted) model_.rig.controller = plan.fitted->controller();
    options_.closed_loop = plan.kind != LoopKind::command;
    options_.hold_torque = torque_held;
    options_.step = step;
  }

  /// False when the simulation diverged.
  bool add(const Window& window) {
    const Eigen::MatrixXd reference = inputs(window);
    if (window.begin == 0) start(window, reference);
    const Eigen::Index n = window.end - window.begin;
    const Eigen::Index there = window.first + window.data.rows() - window.begin;
    const SimulationInput block = input(window, reference, std::min(n + 1, there));
    const SimulationResult result = simulation_->run(block, n);
    if (result.diverged_at) {
      diverged_ =
          window.t0 + static_cast<double>(window.begin + *result.diverged_at) * window.period;
      return false;
    }
    copy_.add(window, result.q, result.theta);
    return true;
  }
  std::optional<double> diverged() const { return diverged_; }  ///< s
  LogSurvey finish() { return copy_.finish(); }

 private:
  int n_joints() const { return log_.plan.rig.n_joints(); }

  /// References, or commanded torques, of all rows of the window, halo and all.
  Eigen::MatrixXd inputs(const Window& window) const {
    Eigen::MatrixXd reference(window.data.rows(), n_joints());
    for (int joint = 0; joint < n_joints(); ++joint)
      reference.col(joint) = window.data.col(log_.plan.find(input_channel(plan_.kind), joint));
    if (plan_.kind == LoopKind::surrogate)
      Butterworth(kSurrogateOrder, plan_.bandwidth, 1 / window.period)
          .apply(reference, window.starts_segment, window.ends_segment);
    return reference;
  }

  SimulationInput input(const Window& window, const Eigen::MatrixXd& reference,
                        Eigen::Index n_rows) const {
    SimulationInput input;
    const Eigen::Index from = window.begin - window.first;
    input.period = window.period;
    (plan_.kind == LoopKind::command ? input.tau : input.theta_ref) =
        reference.middleRows(from, n_rows).array();
    input.tau_load.resize(log_.plan.has_for_all(Channel::tau_load) ? n_rows : 0, n_joints());
    for (int joint = 0; input.tau_load.rows() > 0 && joint < n_joints(); ++joint)
      input.tau_load.col(joint) =
          window.data.col(log_.plan.find(Channel::tau_load, joint)).segment(from, n_rows).array();
    return input;
  }

  void start(const Window& window, const Eigen::MatrixXd& reference) {
    Model model = model_;
    if (plan_.kind == LoopKind::surrogate) {
      const double n = std::max(1.0, std::ceil(window.period / options_.step - 1e-6));
      model.rig.controller =
          controller_by_inertias(model_, false, [&](const JointInertias& inertias) {
            return surrogate(inertias, plan_.bandwidth, window.period / n);
          });
    }
    const Eigen::Index rows = window.data.rows() - (window.begin - window.first);
    SimulationInput first = input(window, reference, std::min<Eigen::Index>(2, rows));
    first.q0 = first.qd0 = first.theta0 = first.thetad0 = Eigen::VectorXd::Zero(n_joints());
    for (int joint = 0; joint < n_joints(); ++joint) {
      const StartState theta = state(window, Channel::theta, joint);
      const StartState q = state(window, Channel::q, joint);
      first.theta0[joint] = theta.position;
      first.thetad0[joint] = theta.velocity;
      first.q0[joint] = q.position;
      first.qd0[joint] = q.velocity;
    }
    simulation_.emplace(model, first, options_);
  }

  StartState state(const Window& window, Channel channel, int joint) const {
    const int slot = log_.plan.find(channel, joint);
    if (slot < 0) return {};
    return start_state(window.data.col(slot).array(), window.begin - window.first, window.period,
                       position_noise(log_, log_.parts[window.part], channel, joint));
  }

  const LogSurvey& log_;
  Model model_;
  const LoopPlan& plan_;
  SimulationOptions options_;
  LogCopy copy_;
  std::optional<Simulation> simulation_;
  std::optional<double> diverged_;
};

/// Rows around a window's own that its loop looks at.
Eigen::Index halo(const LoopPlan& plan, double rate) {
  Eigen::Index rows = kStartRows;
  if (plan.kind == LoopKind::surrogate)
    rows = std::max(rows, Butterworth(kSurrogateOrder, plan.bandwidth, rate).settling_rows());
  return rows + 1;  // the row that a block steps on to
}

struct LoopResult {
  std::optional<LogSurvey> log;
  std::string failure;
};

LoopResult run_loop(const DynamicJob& job, const LogSurvey& log, const Model& model,
                    const LoopPlan& plan) {
  LoopResult result;
  const double rate = sample_rates({&log, 1}, job.wanted).highest;
  for (const double step : {kLoopStep, SimulationOptions{}.step}) {
    LogLoop loop(log, model, plan, job.settings.rows.signal.torque_held, step);
    for_each_window(log, job.wanted, halo(plan, rate), kFewestRows,
                    bridge_seconds(job.settings.rows.signal),
                    [&](Window&& window) { return loop.add(window); });
    if (!loop.diverged()) {
      result.log = loop.finish();
      return result;
    }
    result.failure = fmt::format("{}: the simulation of the loop diverged at t = {:.4g} s",
                                 log.plan.path, *loop.diverged());
  }
  return result;
}

}  // namespace

std::string source_of_instruments(const LoopPlan& plan) {
  switch (plan.kind) {
    case LoopKind::known:
      if (plan.fitted)
        return "noise-free loop of a controller found from the log's reference, position and "
               "torque";
      return "noise-free loop of the rig's controller and the log's reference";
    case LoopKind::command:
      return "the log's torque replayed without noise, as the rig file says that it is a command";
    case LoopKind::surrogate:
      return fmt::format(
          "{}: a surrogate controller follows theta smoothed at {:.3g} Hz; without "
          "encoder noise, but with the disturbances that moved the robot",
          plan.reason, plan.bandwidth);
    case LoopKind::none:
      break;
  }
  return plan.reason;
}

namespace {

// Rows that a controller is checked and found with: its law is exact, so that few will do.
constexpr double kControllerRows = 250000;

/// Whether the rig's controller made the torque; else whether one can be found that did.
void look_at_controller(const DynamicJob& job, std::span<const LogSurvey> logs, bool open_loop,
                        LoopPlan& plan) {
  if (open_loop) return;
  double all = 0;
  for (const LogSurvey& log : logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part)) all += static_cast<double>(part.n_rows);
  std::vector<LogSurvey> some;
  if (all > kControllerRows)
    some = stretches_of(logs, job.wanted, kControllerRows / all,
                        bridge_seconds(job.settings.rows.signal));
  const std::span<const LogSurvey> looked_at = some.empty() ? logs : some;
  if (plan.kind == LoopKind::known) {
    const std::optional<ControllerFits> given = check_controllers(looked_at, job.wanted);
    if (!given || given->all_fit()) return;
    plan.kind = LoopKind::surrogate;
    plan.reason = fmt::format("the rig's controller does not reproduce the log's torque ({})",
                              given->text(job.rig().axes, true));
    plan.warnings.push_back(plan.reason + ": it is not used; check its gains, units and reference");
  }
  const std::optional<ControllerFits> found = fit_controllers(looked_at, job.wanted);
  if (!found || !found->all_fit()) return;
  plan.kind = LoopKind::known;
  plan.fitted = found;
}

}  // namespace

LoopPlan plan_loop(const DynamicJob& job, std::span<const LogSurvey> logs) {
  LoopPlan plan;
  if (job.is_coupled() && job.rigid)
    return {LoopKind::none, "rigid drives of links that move each other are not simulated", 0};
  std::size_t n_logs = 0, n_commanded = 0;
  plan.kind = LoopKind::known;
  for (const LogSurvey& log : logs) {
    if (std::none_of(log.parts.begin(), log.parts.end(), job.wanted)) continue;
    bool has_theta = true;
    for (int joint = 0; joint < job.n_joints(); ++joint)
      has_theta = has_theta && log.plan.has_measured(Channel::theta, joint);
    if (!has_theta)
      return {LoopKind::none, fmt::format("{} has no theta to follow", log.plan.path), 0};
    ++n_logs;
    n_commanded += log.plan.rig.open_loop ? 1 : 0;
    const std::string obstacle = no_known_loop(log.plan);
    if (obstacle.empty()) continue;
    plan.kind = LoopKind::surrogate;
    plan.reason = obstacle;
  }
  if (n_logs > 0 && n_commanded == n_logs) {
    plan.kind = LoopKind::command;
    return plan;
  }
  const double rate = sample_rates(logs, job.wanted).lowest;
  double cutoff = job.settings.rows.signal.cutoff;
  for (int joint = 0; joint < job.n_joints(); ++joint)
    cutoff = std::min(cutoff, job.settings_of(joint).rows.signal.cutoff);
  plan.bandwidth =
      cutoff > 0 ? std::min(kSurrogateShare * cutoff, 0.4 * rate) : kUnfilteredShare * rate;
  look_at_controller(job, logs, n_commanded > 0, plan);
  return plan;
}

LoopPlan without_found_controller(LoopPlan plan) {
  plan.kind = LoopKind::surrogate;
  plan.reason =
      fmt::format("{}the controller found from the logs does not move the model as the robot moved",
                  plan.reason.empty() ? "" : plan.reason + "; ");
  plan.fitted.reset();
  return plan;
}

SimulatedLogs simulate_loops(const DynamicJob& job, std::span<const LogSurvey> logs,
                             const Model& model, const LoopPlan& plan) {
  SimulatedLogs all;
  ordered_pipeline<std::size_t>(
      job.options.samples.threads,
      [&](auto emit) {
        for (std::size_t k = 0; k < logs.size(); ++k)
          if (std::any_of(logs[k].parts.begin(), logs[k].parts.end(), job.wanted))
            emit(std::size_t{k});
      },
      [&](std::size_t k) { return run_loop(job, logs[k], model, plan); },
      [&](LoopResult one) {
        if (one.log) all.logs.push_back(std::move(*one.log));
        if (!one.log && all.failure.empty()) all.failure = one.failure;
      });
  return all;
}

}  // namespace cablefit
