#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parallel.hpp"
#include "cablefit/copies/clock_jitter.hpp"
#include "cablefit/copies/simulated_copy.hpp"

namespace cablefit {
namespace {

Eigen::Index rows_of_input(const CopyStretch& stretch) {
  return (stretch.measured.rows() - 1) * stretch.fine + 1;
}

Eigen::ArrayXXd disturbances(const std::vector<ArModel>& models, const CopyStretch& stretch,
                             Random& random) {
  bool any = false;
  for (const ArModel& model : models) any |= model.sd > 0;
  if (!any) return {};
  const Eigen::Index n_rows = rows_of_input(stretch);
  Eigen::ArrayXXd table(n_rows, static_cast<Eigen::Index>(models.size()));
  for (std::size_t k = 0; k < models.size(); ++k)
    table.col(static_cast<Eigen::Index>(k)) = draw(models[k], n_rows, stretch.input.period, random);
  return table;
}

/// What really happened on a slot; nullptr: it is an input and stays as it was measured.
const Eigen::ArrayXXd* truth_of(const SimulationResult& motion, Channel channel) {
  switch (channel) {
    case Channel::q:
      return &motion.q;
    case Channel::theta:
      return &motion.theta;
    case Channel::w:
      return &motion.thetad;
    case Channel::tau:
      return &motion.tau;
    case Channel::tau_load:
    case Channel::theta_ref:
      return nullptr;
  }
  return nullptr;
}

Eigen::ArrayXd measure(const Eigen::ArrayXd& truth, const CopySensor& sensor, Random& random) {
  Eigen::ArrayXd out = truth;
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (sensor.noise != 0) out(i) += sensor.noise * random.normal();
    if (sensor.quantum > 0) out(i) = sensor.quantum * std::round(out(i) / sensor.quantum);
  }
  return out;
}

/// The motion as it was when each row was really read.
SimulationResult read_late(SimulationResult motion, double jitter, Random& random) {
  for (Eigen::Index i = 0; i < motion.q.rows(); ++i) {
    const double late = jitter * random.normal();
    motion.q.row(i) += late * motion.qd.row(i);
    motion.theta.row(i) += late * motion.thetad.row(i);
  }
  return motion;
}

/// [t, slots] of a stretch.
Eigen::MatrixXd recorded_rows(const CopyStretch& stretch, const SimulationResult& motion,
                              const LogPlan& plan, const std::vector<CopySensor>& sensors,
                              Random& random) {
  Eigen::MatrixXd rows(stretch.measured.rows(), stretch.measured.cols() + 1);
  rows.rightCols(stretch.measured.cols()) = stretch.measured;
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows(i, 0) = stretch.t0 + static_cast<double>(i) * stretch.period;
  for (std::size_t k = 0; k < plan.slots.size(); ++k) {
    const Slot& slot = plan.slots[k];
    const Eigen::ArrayXXd* truth = truth_of(motion, slot.channel);
    if (truth == nullptr) continue;
    if (stretch.link_blocked && slot.channel == Channel::q) continue;
    rows.col(static_cast<Eigen::Index>(k) + 1) =
        measure(truth->col(slot.joint), sensors.empty() ? CopySensor{} : sensors[k], random);
  }
  return rows;
}

/// Of a finer simulation the rows of the log. A command is held over a fine row, so that a mean
/// over the log's row, centred, is one of as many commands, half of them from before. A log that is
/// early has what acts later.
SimulationResult on_rows_of_log(SimulationResult fine, const CopyStretch& stretch) {
  if (stretch.fine == 1) return fine;
  const Eigen::Index n = stretch.fine, rows = stretch.measured.rows();
  const auto every = Eigen::seqN(Eigen::Index{0}, rows, n);
  SimulationResult out;
  out.diverged_at = fine.diverged_at;
  for (const auto channel : {&SimulationResult::q, &SimulationResult::theta, &SimulationResult::qd,
                             &SimulationResult::thetad, &SimulationResult::tension})
    if ((fine.*channel).rows() > 0)
      out.*channel = Eigen::ArrayXXd((fine.*channel)(every, Eigen::all));
  out.tau = Eigen::ArrayXXd::Zero(rows, fine.tau.cols());
  const double later = stretch.late / stretch.input.period, whole = std::floor(later);
  const double rest = later - whole;  // of a fine row: that much of the last one, not of the first
  const Eigen::Index last = fine.tau.rows() - 1;
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index k = 0; k <= n; ++k) {
      const double share = k == 0 ? 1 - rest : k == n ? rest : 1;
      const Eigen::Index at = i * n - n / 2 + static_cast<Eigen::Index>(whole) + k;
      out.tau.row(i) +=
          share * fine.tau.row(std::clamp<Eigen::Index>(at, 0, last)) / static_cast<double>(n);
    }
  return out;
}

RecordedPart begin_part(const PartSurvey& part) {
  return {part.preload, part.run, part.phase, true, {}};
}

/// What the rig file says of a slot's sensor; nullptr: nothing.
const SensorInfo* sensor_of(const LogPlan& plan, const Slot& slot) {
  const std::string name(channel_name(slot.channel));
  auto found =
      plan.rig.sensors.find(plan.rig.n_joints() > 1 ? name + std::to_string(slot.joint + 1) : name);
  if (found == plan.rig.sensors.end()) found = plan.rig.sensors.find(name);
  return found == plan.rig.sensors.end() ? nullptr : &found->second;
}

/// A stretch with the disturbances that it is simulated with.
struct StretchRun {
  const CopyStretch* stretch;
  SimulationInput input;
};

bool is_position(Channel channel) { return channel == Channel::q || channel == Channel::theta; }

/// White noise that the measured channel has more than the simulated one; `known`: sd of what is
/// simulated besides.
double noise_left(const ChannelSurvey& measured, const ChannelSurvey& simulated, double known) {
  const double more =
      measured.noise * measured.noise - simulated.noise * simulated.noise - known * known;
  return more > 0 ? std::sqrt(more) : 0;
}

double jitter_of(const LogPlan& plan, const CopyStretch& stretch, const SimulationResult& motion) {
  const int q = plan.find(Channel::q), theta = plan.find(Channel::theta);
  if (q < 0 || theta < 0 || stretch.link_blocked) return 0;
  return clock_jitter({stretch.measured.col(q), stretch.measured.col(theta)},
                      {motion.q.col(0), motion.theta.col(0)},
                      motion.qd.col(0) * motion.thetad.col(0));
}

/// sd of a position's noise by that jitter.
double jitter_noise(const SimulationResult& motion, const Slot& slot, double jitter) {
  if (!is_position(slot.channel)) return 0;
  const Eigen::ArrayXXd& speed = slot.channel == Channel::q ? motion.qd : motion.thetad;
  return jitter * std::sqrt(speed.col(slot.joint).square().mean());
}

}  // namespace

std::vector<SimulationResult> run_copy(const SimulatedCopy& copy,
                                       const CopyDisturbance& disturbance, Random& random,
                                       int threads) {
  std::vector<StretchRun> runs;
  for (const CopyStretch& stretch : copy.stretches) {
    StretchRun& run = runs.emplace_back(StretchRun{&stretch, stretch.input});
    run.input.motor_disturbance = disturbances(disturbance.motor, stretch, random);
    if (!stretch.link_blocked)
      run.input.link_disturbance = disturbances(disturbance.link, stretch, random);
  }
  return parallel_map(threads, runs, [&](const StretchRun& run) {
    Model model = copy.model;
    model.rig = run.stretch->rig;
    SimulationOptions options;
    options.step = copy.step;
    options.closed_loop = run.stretch->rig.controller.has_value();
    options.hold_torque = run.stretch->hold_torque;
    options.link_blocked = run.stretch->link_blocked;
    SimulationResult motion = simulate(model, run.input, options);
    if (motion.diverged_at)
      throw Error(ErrorKind::not_identifiable,
                  fmt::format("the simulated loop of {} diverged; a value of the rig file may be "
                              "wrong (gravity, a radius, a unit)",
                              copy.plans[run.stretch->log].path));
    return on_rows_of_log(std::move(motion), *run.stretch);
  });
}

std::vector<LogSurvey> record_copy(const SimulatedCopy& copy,
                                   const std::vector<SimulationResult>& motions, Random& random) {
  std::vector<LogSurvey> logs;
  for (std::size_t log = 0; log < copy.plans.size(); ++log) {
    std::vector<RecordedPart> parts;
    std::size_t last = copy.parts[log].size();
    for (std::size_t k = 0; k < copy.stretches.size(); ++k) {
      const CopyStretch& stretch = copy.stretches[k];
      if (stretch.log != log) continue;
      if (stretch.part != last) parts.push_back(begin_part(copy.parts[log][stretch.part]));
      last = stretch.part;
      const std::vector<CopySensor> sensors =
          copy.sensors.empty() ? std::vector<CopySensor>{} : copy.sensors[log];
      const double jitter = copy.jitter.empty() ? 0 : copy.jitter[log];
      const Eigen::MatrixXd rows =
          jitter > 0 ? recorded_rows(stretch, read_late(motions[k], jitter, random),
                                     copy.plans[log], sensors, random)
                     : recorded_rows(stretch, motions[k], copy.plans[log], sensors, random);
      Eigen::MatrixXd& all = parts.back().rows;
      all.conservativeResize(all.rows() + rows.rows(), rows.cols());
      all.bottomRows(rows.rows()) = rows;
    }
    if (!parts.empty()) logs.push_back(survey_recorded(copy.plans[log], parts));
  }
  return logs;
}

namespace {

/// Prefers a moving stretch: the encoder of a blocked link shows no steps.
std::vector<CopyStretch>::const_iterator stretch_for_sensors(const SimulatedCopy& copy,
                                                             std::size_t log) {
  const auto first = [&](bool moving) {
    return std::find_if(copy.stretches.begin(), copy.stretches.end(), [&](const CopyStretch& s) {
      return s.log == log && !(moving && s.link_blocked);
    });
  };
  const auto moving = first(true);
  return moving != copy.stretches.end() ? moving : first(false);
}

}  // namespace

void choose_sensors(SimulatedCopy& copy, const std::vector<SimulationResult>& motions) {
  copy.sensors.clear();
  copy.jitter.assign(copy.plans.size(), 0);
  for (std::size_t log = 0; log < copy.plans.size(); ++log) {
    const LogPlan& plan = copy.plans[log];
    std::vector<CopySensor>& sensors = copy.sensors.emplace_back(plan.slots.size());
    const auto first = stretch_for_sensors(copy, log);
    if (first == copy.stretches.end()) continue;
    const auto& motion = motions[static_cast<std::size_t>(first - copy.stretches.begin())];
    const PartSurvey& part = copy.parts[log][first->part];
    copy.jitter[log] = jitter_of(plan, *first, motion);
    for (std::size_t k = 0; k < plan.slots.size(); ++k) {
      const SensorInfo* info = sensor_of(plan, plan.slots[k]);
      const bool position = is_position(plan.slots[k].channel);
      sensors[k].quantum = info != nullptr && info->quantum ? *info->quantum
                           : position                       ? part.channels[k].quantum
                                                            : 0;
      const bool is_given = info != nullptr && (info->noise || (position && info->quantum));
      if (is_given) sensors[k].noise = info->noise.value_or(0);
      const Eigen::ArrayXXd* truth = truth_of(motion, plan.slots[k].channel);
      if (is_given || truth == nullptr) continue;
      Random none(0);
      ChannelScan scan;
      scan.add(measure(truth->col(plan.slots[k].joint), sensors[k], none));
      sensors[k].noise = noise_left(part.channels[k], scan.result(),
                                    jitter_noise(motion, plan.slots[k], copy.jitter[log]));
    }
  }
}

}  // namespace cablefit
