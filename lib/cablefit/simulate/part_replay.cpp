#include "cablefit/simulate/part_replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/samples/survey/noise.hpp"
#include "cablefit/simulate/corrections.hpp"

namespace cablefit {
namespace {

Eigen::Index rows_in(double seconds, double period) {
  if (seconds <= 0) return 0;
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::llround(seconds / period)));
}

/// The first rows only.
void cut(Eigen::Index n_rows, ReplayedRows* rows) {
  for (Eigen::ArrayXXd* table :
       {&rows->q, &rows->theta, &rows->tau, &rows->simulated.q, &rows->simulated.theta,
        &rows->simulated.qd, &rows->simulated.thetad, &rows->simulated.tau,
        &rows->simulated.tension}) {
    table->conservativeResize(n_rows, Eigen::NoChange);
  }
  if (rows->band.empty()) return;
  for (Eigen::ArrayXXd* table :
       {&rows->band.q, &rows->band.theta, &rows->band.deflection, &rows->band.tau})
    table->conservativeResize(n_rows, Eigen::NoChange);
}

std::string unit_of(Channel channel, Axes axes) {
  const char* unit = channel == Channel::tau ? "N m" : "rad";
  return unit_for(axes, unit);
}

}  // namespace

Eigen::Index replay_halo(const Model& model) {
  return kReplayHalo + (corrects(model) ? kCorrectionHalo : 0);
}

PartReplay::PartReplay(Experiment experiment, const LogSurvey& log, const PartSurvey& part,
                       std::size_t log_number, int band_threads)
    : experiment_(std::move(experiment)),
      log_(log),
      part_(part),
      log_number_(log_number),
      window_rows_(rows_in(experiment_.window_seconds, part.period)) {
  result_.log = log.plan.path;
  result_.preload = part.preload;
  result_.phase = to_string(part.phase);
  result_.run = part.run;
  result_.closed_loop = experiment_.simulation.closed_loop;
  result_.held_torque = !result_.closed_loop && experiment_.simulation.hold_torque;
  result_.window_seconds = experiment_.window_seconds;
  result_.decisions = experiment_.decisions;
  result_.warnings = experiment_.warnings;
  if (band_threads > 0) moved_.emplace(experiment_.model, experiment_.simulation, band_threads);
  choose_signals();
}

void PartReplay::choose_signals() {
  const LogPlan& plan = log_.plan;
  const int n_joints = plan.rig.n_joints();
  // Of all joints or of none, as `measured` reads them.
  const bool has_q = plan.has_for_all(Channel::q), has_tau = plan.has_for_all(Channel::tau);
  for (int joint = 0; joint < n_joints; ++joint) {
    if (has_q) signals_.push_back({Channel::q, joint});
    signals_.push_back({Channel::theta, joint});
    if (has_q) signals_.push_back({Channel::theta, joint, true});
    if (result_.closed_loop && has_tau) signals_.push_back({Channel::tau, joint});
  }
  for (Signal& signal : signals_) {
    signal.noise = position_noise(log_, part_, signal.channel, signal.joint);
    if (signal.is_deflection)
      signal.noise =
          std::hypot(signal.noise, position_noise(log_, part_, Channel::q, signal.joint));
  }
}

Eigen::ArrayXd PartReplay::Signal::measured(const ReplayedRows& rows) const {
  if (is_deflection) return rows.theta.col(joint) - rows.q.col(joint);
  if (channel == Channel::q) return rows.q.col(joint);
  return (channel == Channel::theta ? rows.theta : rows.tau).col(joint);
}

Eigen::ArrayXd PartReplay::Signal::simulated(const ReplayedRows& rows) const {
  const SimulationResult& s = rows.simulated;
  if (is_deflection) return s.theta.col(joint) - s.q.col(joint);
  if (channel == Channel::q) return s.q.col(joint);
  return (channel == Channel::theta ? s.theta : s.tau).col(joint);
}

Eigen::ArrayXd PartReplay::Signal::half_width(const ReplayedRows& rows) const {
  const SimulationBand& all = rows.band;
  if (is_deflection) return all.deflection.col(joint);
  if (channel == Channel::q) return all.q.col(joint);
  return (channel == Channel::theta ? all.theta : all.tau).col(joint);
}

void PartReplay::add(const Window& window, const RowSink& sink) {
  if (!corrects(experiment_.model)) {
    add_corrected(window, sink);
    return;
  }
  Window corrected = window;
  correct(experiment_.model, log_.plan, experiment_.simulation.closed_loop, corrected);
  add_corrected(corrected, sink);
}

void PartReplay::add_corrected(const Window& window, const RowSink& sink) {
  Eigen::Index row = window.begin;
  while (row < window.end && result_.diverged.empty()) {
    const bool starts = window_rows_ > 0 ? row % window_rows_ == 0 : row == 0;
    if (starts) start_anew(window, row);
    const Eigen::Index next_start =
        window_rows_ > 0 ? (row / window_rows_ + 1) * window_rows_ : window.end;
    const Eigen::Index end = std::min(window.end, next_start);
    simulate_rows(window, row, end, sink);
    row = end;
  }
}

Eigen::ArrayXXd PartReplay::measured(const Window& window, Channel channel, Eigen::Index begin,
                                     Eigen::Index n_rows) const {
  const int n_joints = log_.plan.rig.n_joints();
  Eigen::ArrayXXd table(n_rows, n_joints);
  for (int joint = 0; joint < n_joints; ++joint) {
    const int slot = log_.plan.find(channel, joint);
    if (slot < 0) return Eigen::ArrayXXd(n_rows, 0);
    table.col(joint) = window.data.col(slot).segment(begin - window.first, n_rows);
  }
  return table;
}

SimulationInput PartReplay::input_rows(const Window& window, Eigen::Index begin,
                                       Eigen::Index n_rows) const {
  SimulationInput input;
  input.period = window.period;
  input.tau = measured(window, Channel::tau, begin, n_rows);
  input.tau_load = measured(window, Channel::tau_load, begin, n_rows);
  input.theta_ref = measured(window, Channel::theta_ref, begin, n_rows);
  return input;
}

void PartReplay::start_anew(const Window& window, Eigen::Index row) {
  const int n_joints = log_.plan.rig.n_joints();
  const Eigen::Index rows_after = window.data.rows() - (row - window.first);
  SimulationInput start = input_rows(window, row, std::min<Eigen::Index>(2, rows_after));
  start.log_number = log_number_;
  const double t = window.t0 + static_cast<double>(row) * window.period;
  start.t0 = t - log_.parts.front().t_first;
  start.q0 = start.qd0 = start.theta0 = start.thetad0 = Eigen::VectorXd::Zero(n_joints);
  const auto state_of = [&](Channel channel, int joint) -> StartState {
    const int slot = log_.plan.find(channel, joint);
    if (slot < 0) return {};
    return start_state(window.data.col(slot).array(), row - window.first, window.period,
                       position_noise(log_, part_, channel, joint));
  };
  for (int joint = 0; joint < n_joints; ++joint) {
    const StartState q = state_of(Channel::q, joint);
    const StartState theta = state_of(Channel::theta, joint);
    start.q0[joint] = q.position;
    start.qd0[joint] = q.velocity;
    start.theta0[joint] = theta.position;
    start.thetad0[joint] = theta.velocity;
  }
  Simulation anew(experiment_.model, start, experiment_.simulation);
  if (simulation_) anew.take_history(*simulation_);
  simulation_.emplace(std::move(anew));
  if (moved_) moved_->start(start);
  ++result_.n_windows;
  for (Signal& signal : signals_) signal.scan.start_window(t);
}

void PartReplay::simulate_rows(const Window& window, Eigen::Index begin, Eigen::Index end,
                               const RowSink& sink) {
  const Eigen::Index n_rows = end - begin;
  const Eigen::Index rows_there = window.first + window.data.rows() - begin;
  const SimulationInput block = input_rows(window, begin, std::min(n_rows + 1, rows_there));
  ReplayedRows rows;
  rows.start = result_.n_windows;
  rows.t0 = window.t0 + static_cast<double>(begin) * window.period;
  rows.period = window.period;
  rows.q = measured(window, Channel::q, begin, n_rows);
  rows.theta = measured(window, Channel::theta, begin, n_rows);
  rows.tau = block.tau.topRows(n_rows);
  rows.simulated = simulation_->run(block, n_rows);
  if (moved_) rows.band = moved_->run(block, n_rows, rows.simulated);
  if (const auto row = rows.simulated.diverged_at) diverge(rows, *row);
  if (rows.simulated.diverged_at) cut(*rows.simulated.diverged_at, &rows);
  compare(rows);
  if (sink) sink(rows);
}

void PartReplay::diverge(const ReplayedRows& rows, Eigen::Index row) {
  result_.diverged = fmt::format(
      "{}: the simulation diverged at t = {:.6g} s (row {} of {} '{}'), a position "
      "or velocity is beyond 1e6 or not a number{}",
      result_.log, rows.t0 + static_cast<double>(row) * rows.period,
      result_.n_rows + static_cast<std::size_t>(row) + 1, result_.phase, result_.preload,
      experiment_.model.is_coupled()
          ? ", or the arm's M(q) is not positive definite there: its base parameters are not "
            "physical"
          : "");
}

void PartReplay::compare(const ReplayedRows& rows) {
  const SimulationResult& s = rows.simulated;
  const auto n = static_cast<double>(s.theta.rows());
  const double before = std::ceil((experiment_.compared_from - rows.t0) / rows.period);
  const auto first = static_cast<Eigen::Index>(std::clamp(before, 0.0, n));
  const double t0 = rows.t0 + static_cast<double>(first) * rows.period;
  const Eigen::Index compared = s.theta.rows() - first;
  for (Signal& signal : signals_) {
    const Eigen::ArrayXd measured = signal.measured(rows).tail(compared);
    const Eigen::ArrayXd simulated = signal.simulated(rows).tail(compared);
    signal.scan.add(measured, simulated, t0, rows.period);
    if (!rows.band.empty())
      signal.band.add(measured - simulated, signal.half_width(rows).tail(compared), signal.noise);
  }
  tensions_.add(s.tension);
  result_.n_rows += static_cast<std::size_t>(s.theta.rows());
}

SignalGap PartReplay::gap_of(const Signal& signal) const {
  SignalGap gap;
  gap.signal = signal.is_deflection ? "deflection" : channel_name(signal.channel);
  if (log_.plan.rig.n_joints() > 1) gap.signal += std::to_string(signal.joint + 1);
  gap.unit = unit_of(signal.channel, log_.plan.rig.axes.of(signal.joint));
  gap.noise = signal.noise;
  signal.scan.fill(gap);
  signal.band.fill(gap);
  return gap;
}

SimulatedPart PartReplay::result() const {
  SimulatedPart part = result_;
  if (part.n_rows == 0) return part;
  for (const Signal& signal : signals_) part.gaps.push_back(gap_of(signal));
  const Model& model = experiment_.model;
  if (model.rigid || model.transmission.cables.empty()) return part;
  const std::string tension =
      model.rig.cables_given ? "N" : unit_of(Channel::tau, model.rig.axes.all());
  part.cables = tensions_.cables(model.transmission, tension);
  part.closure_share = tensions_.closure_share();
  return part;
}

}  // namespace cablefit
