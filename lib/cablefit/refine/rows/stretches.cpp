#include "cablefit/refine/rows/stretches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/rows/rough_start.hpp"
#include "cablefit/samples/survey/gapless_rows.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kLeastRows = 64;  // a shorter stretch is all edge
// s: holes of an uneven log that are interpolated over where nothing moves fast, a quarter period
// of the 10 Hz that stage 1 looks at.
constexpr double kBlockedBridge = 0.025;
constexpr std::string_view kWhy = "comparing the model's equations with the log";

std::size_t model_of(std::span<const Model> models, const LogPlan& plan, const PartSurvey& part) {
  if (models.size() == 1) return 0;
  const auto found = std::find_if(models.begin(), models.end(), [&](const Model& model) {
    return model.preload == part.preload;
  });
  if (found != models.end()) return static_cast<std::size_t>(found - models.begin());
  throw input_error({plan.path}, fmt::format("no model of preload '{}'", part.preload),
                    "give a model of every preload, or leave the log out");
}

void require_channels(const LogPlan& plan, const Model& model, bool blocked) {
  if (model.whole == nullptr) require_one_joint(plan, "a model of one joint fits no other rig");
  require_channel(plan, Channel::theta, kWhy);
  require_channel(plan, Channel::tau, kWhy);
  if (!model.rigid && !blocked) require_channel(plan, Channel::q, kWhy);
  const Load& load = plan.rig.load;
  if (!blocked && load.law != nullptr && load.law->from_column)
    require_channel(plan, Channel::tau_load, "the load that the rig file says is a column");
}

/// Of all joints, samples x joints; 0 where it was not logged, as of a blocked link.
Eigen::ArrayXXd columns(const GaplessRows& run, const LogPlan& plan, Channel channel) {
  const int n = plan.rig.n_joints();
  Eigen::ArrayXXd all = Eigen::ArrayXXd::Zero(run.data.rows(), n);
  for (int joint = 0; joint < n; ++joint)
    if (plan.has(channel, joint)) all.col(joint) = run.column(plan, channel, joint);
  return all;
}

Recording recording_of(const GaplessRows& run, const LogPlan& plan, const Model& model) {
  Recording r;
  r.period = run.period;
  r.q = run.column(plan, Channel::q, model.joint);
  r.theta = run.column(plan, Channel::theta, model.joint);
  r.tau = run.column(plan, Channel::tau, model.joint);
  r.tau_load = run.column(plan, Channel::tau_load, model.joint);
  if (model.whole == nullptr) return r;
  const Eigen::ArrayXXd q = columns(run, plan, Channel::q);
  r.others = others_elongation(model, q, columns(run, plan, Channel::theta));
  r.links = q(Eigen::all, linked_joints(model));
  r.joint = own_place(model);
  return r;
}

/// q of a blocked link that was not logged stands at 0; of a rigid drive it is theta.
void complete(const Model& model, const Rig& rig, Stretch& stretch) {
  Recording& r = stretch.recording;
  if (r.q.size() == 0) r.q = model.rigid ? r.theta : Eigen::ArrayXd::Zero(r.theta.size());
  const Load& load = rig.load.law != nullptr ? rig.load : model.rig.load;
  if (r.tau_load.size() == 0) r.tau_load = Eigen::ArrayXd::Zero(r.theta.size());
  if (load.law == nullptr || load.law->from_column) return;
  for (Eigen::Index i = 0; i < r.q.size(); ++i)
    r.tau_load(i) = load.law->torque(load.parameters, r.q(i));
}

void read_log(const LogSurvey& log, std::size_t number, std::span<const Model> models,
              const PartFilter& wanted, std::vector<Stretch>& stretches) {
  const double began = log.parts.front().t_first;
  const bool blocked = std::all_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& p) {
    return !wanted(p) || p.phase == Phase::blocked;
  });
  for_each_run(log, wanted, kLeastRows, blocked ? kBlockedBridge : 0, [&](GaplessRows&& run) {
    const PartSurvey& part = log.parts[run.part];
    Stretch& stretch = stretches.emplace_back();
    stretch.log = number;
    stretch.model = model_of(models, log.plan, part);
    const Model& model = models[stretch.model];
    stretch.blocked = part.phase == Phase::blocked;
    stretch.t0 = run.t0 - began;
    stretch.part_begin = part.t_first - began;
    stretch.part_end = part.t_last - began;
    require_channels(log.plan, model, stretch.blocked);
    stretch.recording = recording_of(run, log.plan, model);
    complete(model, log.plan.rig, stretch);
    const bool begins_part = stretch.t0 < stretch.part_begin + 0.5 * run.period;
    if (begins_part && !stretch.blocked) stretch.rows_from = rough_start(stretch.recording);
  });
}

}  // namespace

std::vector<Stretch> read_stretches(std::span<const LogSurvey> logs, std::span<const Model> models,
                                    const PartFilter& wanted) {
  std::vector<Stretch> stretches;
  for (std::size_t k = 0; k < logs.size(); ++k)
    if (std::any_of(logs[k].parts.begin(), logs[k].parts.end(), wanted))
      read_log(logs[k], k, models, wanted, stretches);
  return stretches;
}

double finest_period(std::span<const Stretch> stretches, bool blocked) {
  double finest = kUnbounded;
  for (const Stretch& stretch : stretches)
    if (stretch.blocked == blocked) finest = std::min(finest, stretch.recording.period);
  return finest;
}

namespace {

constexpr double kMostlyGaps = 0.5;  // of the time of a part

double duration(const Stretch& stretch) {
  return static_cast<double>(stretch.recording.theta.size()) * stretch.recording.period;
}

/// When the last share of a part begins. A part that is mostly gaps is shared by the time that was
/// recorded: its clock says nothing of where the samples are.
double beginning_of_last(double share, const Stretch& of, const std::vector<Stretch>& stretches) {
  const auto is_same_part = [&](const Stretch& other) {
    return other.log == of.log && other.part_begin == of.part_begin;
  };
  const double end = of.part_end + of.recording.period;
  double recorded = 0;
  for (const Stretch& stretch : stretches)
    if (is_same_part(stretch)) recorded += duration(stretch);
  if (recorded > kMostlyGaps * (end - of.part_begin)) return end - share * (end - of.part_begin);
  double left = share * recorded;
  for (auto stretch = stretches.rbegin(); stretch != stretches.rend(); ++stretch) {
    if (!is_same_part(*stretch)) continue;
    if (duration(*stretch) >= left) return stretch->t0 + duration(*stretch) - left;
    left -= duration(*stretch);
  }
  return of.part_begin;
}

}  // namespace

std::vector<Stretch> hold_out(std::vector<Stretch>& stretches, double share, HoldOut which) {
  std::vector<Stretch> held;
  std::vector<double> held_from;
  for (const Stretch& stretch : stretches)
    held_from.push_back(beginning_of_last(share, stretch, stretches));
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    Stretch& stretch = stretches[k];
    if (stretch.blocked && which == HoldOut::moving) continue;
    const Eigen::Index n = stretch.recording.theta.size();
    const double samples = std::round((held_from[k] - stretch.t0) / stretch.recording.period);
    const auto kept = static_cast<Eigen::Index>(std::clamp(samples, 0.0, static_cast<double>(n)));
    if (kept < n) {
      held.push_back(stretch);
      held.back().rows_from = std::max(kept, stretch.rows_from);
    }
    for (Eigen::ArrayXd Recording::*signal :
         {&Recording::q, &Recording::theta, &Recording::tau, &Recording::tau_load})
      stretch.recording.*signal = Eigen::ArrayXd((stretch.recording.*signal).head(kept));
    for (Eigen::ArrayXXd Recording::*table : {&Recording::others, &Recording::links})
      if ((stretch.recording.*table).cols() > 0)
        stretch.recording.*table = Eigen::ArrayXXd((stretch.recording.*table).topRows(kept));
  }
  std::erase_if(stretches, [](const Stretch& s) { return s.recording.theta.size() < kLeastRows; });
  return held;
}

bool is_blocked_only(std::span<const Stretch> stretches) {
  return std::all_of(stretches.begin(), stretches.end(),
                     [](const Stretch& stretch) { return stretch.blocked; });
}

}  // namespace cablefit
