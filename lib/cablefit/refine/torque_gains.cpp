#include "cablefit/refine/torque_gains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "cablefit/estimate/spread/tail_probability.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/kept_joint.hpp"
#include "cablefit/refine/scaled_torque.hpp"
#include "cablefit/refine/shared_gap.hpp"

namespace cablefit {
namespace {

constexpr double kInterval = 0.95;
constexpr std::string_view kScaleClass = "scale";

bool any_off(const std::vector<JointScale>& scales) {
  return std::any_of(scales.begin(), scales.end(), [](const JointScale& s) { return s.is_off(); });
}

/// The first model of each joint; nullptr: it has none.
template <typename Joints, typename Get>
std::vector<const Model*> first_of(const Joints& joints, Get models_of) {
  std::vector<const Model*> first;
  for (const auto& joint : joints) {
    const std::vector<Model>& models = models_of(joint);
    first.push_back(models.empty() ? nullptr : &models.front());
  }
  return first;
}

/// Whether a log has a load on the joint (from 0).
bool is_loaded(const RefineLogs& logs, int joint) {
  const std::vector<LogSurvey> fitted = logs.fitted();
  return std::any_of(fitted.begin(), fitted.end(), [&](const LogSurvey& log) {
    const int slot = log.plan.find(Channel::tau_load, joint);
    return slot >= 0 &&
           std::any_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& part) {
             const ChannelSurvey& load = part.channels[static_cast<std::size_t>(slot)];
             return load.min != 0 || load.max != 0;
           });
  });
}

std::vector<TorqueTrust> trust_by_loads(const RefineLogs& logs, int n_joints) {
  std::vector<TorqueTrust> trust;
  for (int joint = 0; joint < n_joints; ++joint)
    trust.push_back(is_loaded(logs, joint) ? TorqueTrust::weighed : TorqueTrust::unknown);
  return trust;
}

bool is_scale(const EffectInstance& instance) {
  return instance.effect->alias_class == kScaleClass;
}

bool has_scale(const RefineResult& r) {
  return std::any_of(r.effects.begin(), r.effects.end(),
                     [](const NamedEffect& effect) { return is_scale(effect.instance); });
}

EffectInstance instance_of(const Effect& row, const JointScale& scale) {
  EffectInstance instance{&row, {}};
  Estimate& a = instance.parameters.emplace_back();
  a.name = row.parameters.front().name;
  a.symbol = row.parameters.front().symbol;
  a.value = 1 - scale.scale;
  a.sd = scale.sd;
  const double half = t_quantile(1 - kInterval, scale.n - 1) * a.sd;
  a.ci_low = a.value - half;
  a.ci_high = a.value + half;
  return instance;
}

std::vector<Rival> rivals_of(const JointScale& scale, const Effect& row) {
  std::vector<Rival> rivals;
  for (const int joint : scale.rivals) {
    Rival& rival = rivals.emplace_back();
    rival.name = row.name;
    rival.side = to_string(row.site);
    rival.gain = 1;
    rival.by_rule = true;
    rival.experiment = row.experiment;
    rival.joint = joint + 1;
  }
  return rivals;
}

/// Before: as the others' values leave the equations.
void widen_before(const SharedGap& gap, RefineResult& r) {
  r.rho_before *= gap.train;
  r.torque.train_before *= std::sqrt(gap.train);
  const double test = std::sqrt(gap.test);
  r.torque.test_before *= test;
  for (double& end : r.torque.test_before_ci) end *= test;
}

/// All but the motor in the torque of the other joints.
void take_scale(const JointScale& scale, const EffectInstance& effect, RefineResult& r) {
  for (ParameterShift& shift : r.shifts) {
    if (is_of_motor(r.models.front(), shift.name)) continue;
    const double by = torque_power(shift.unit, 1 / scale.scale);
    shift.after *= by;
    shift.sd *= by;
  }
  for (Model& model : r.models) {
    model = with_link_torque_times(std::move(model), 1 / scale.scale);
    std::erase_if(model.joints.front().added, is_scale);
    model.joints.front().added.push_back(effect);
  }
}

void add_torque_gain(const JointScale& scale, const Model& agreed, const RefineLogs& logs,
                     RefineResult& r) {
  const SharedGap gap = shared_gap(r.models, one_joint(agreed, r.joint - 1), logs);
  NamedEffect effect;
  effect.instance = instance_of(find_candidate("torque_gain", Site::drive), scale);
  effect.joint = r.joint;
  effect.torque_rms = std::abs(1 - 1 / scale.scale) * gap.elastic_torque;
  effect.rivals = rivals_of(scale, *effect.instance.effect);
  effect.evidence.gain = gap.test > 1 ? 1 - 1 / gap.test : 0;
  effect.evidence.rho_before = r.rho_before * gap.train;
  effect.evidence.rho_after = r.rho_before;
  effect.evidence.p_value = scale.chance;
  effect.evidence.inclusion = 1;
  widen_before(gap, r);
  take_scale(scale, effect.instance, r);
  r.reason = fmt::format(
      "what it shares with other joints differs by one factor, {:.4g} +- {:.1g} ({} values, {:.4g} "
      "% of their squared disagreement)",
      scale.scale, scale.sd, scale.n, 100 * scale.explained);
  r.search_p = std::min(r.search_p, scale.chance);
  if (!effect.rivals.empty()) {
    r.next_experiment = effect.instance.effect->experiment;
    r.next_run.reset();
  }
  r.verdict = effect.rivals.empty() ? Verdict::named : Verdict::ambiguous;
  r.effects.push_back(std::move(effect));
}

/// A wrong torque and a wrong load look the same to one joint. Others tell them apart: with the
/// right one of the two the joint's values agree with theirs.
void settle_scale(const JointScale& scale, NamedEffect& own, RefineResult& r) {
  if (!scale.compared) return;
  if (scale.is_off()) {
    const bool was_torque = own.instance.effect->site == Site::drive;
    own.instance = instance_of(was_torque ? find_candidate("load_scale", Site::link)
                                          : find_candidate("torque_gain", Site::drive),
                               scale);
    take_scale(scale, own.instance, r);
  }
  std::erase_if(own.rivals, [](const Rival& rival) { return rival.by_rule; });
  const bool is_open = std::any_of(r.effects.begin(), r.effects.end(),
                                   [](const NamedEffect& e) { return !e.rivals.empty(); });
  if (r.verdict == Verdict::ambiguous && !is_open) r.verdict = Verdict::named;
}

}  // namespace

ComparedTorques compared_torques(const std::vector<Model>& models, const RefineLogs& logs,
                                 double significance) {
  const auto n = static_cast<int>(models.front().joints.size());
  std::vector<std::vector<Model>> fits;
  for (int joint = 0; joint < n; ++joint)
    fits.push_back(base_estimates(one_joint(models, joint), logs).value_or(std::vector<Model>{}));
  const auto models_of = [](const std::vector<Model>& fit) -> const std::vector<Model>& {
    return fit;
  };
  ComparedTorques torques;
  torques.scales = joint_scales(first_of(fits, models_of), trust_by_loads(logs, n), significance);
  if (!any_off(torques.scales)) return torques;
  for (std::size_t m = 0; m < models.size(); ++m) {
    std::vector<Model> own;
    for (int joint = 0; joint < n; ++joint) {
      const auto at = static_cast<std::size_t>(joint);
      own.push_back(fits[at].empty()
                        ? one_joint(models[m], joint)
                        : with_torque_times(fits[at][m], 1 / torques.scales[at].scale));
    }
    torques.agreed.push_back(joined(own));
  }
  return torques;
}

std::vector<Model> start_of(int joint, std::span<const Model> models,
                            const ComparedTorques& torques) {
  if (torques.agreed.empty()) return one_joint(models, joint);
  const double scale = torques.scales[static_cast<std::size_t>(joint)].scale;
  std::vector<Model> own;
  for (const Model& model : torques.agreed) own.push_back(with_torque_times(model, scale));
  return one_joint(own, joint);
}

void name_torque_gains(const ComparedTorques& torques, const RefineLogs& logs, double significance,
                       std::vector<RefineResult>& joints) {
  if (torques.agreed.empty() && std::none_of(joints.begin(), joints.end(), has_scale)) return;
  std::vector<TorqueTrust> trust = trust_by_loads(logs, static_cast<int>(joints.size()));
  for (std::size_t k = 0; k < joints.size(); ++k)
    if (has_scale(joints[k])) trust[k] = TorqueTrust::off;
  const auto models_of = [](const RefineResult& r) -> const std::vector<Model>& {
    return r.models;
  };
  const std::vector<JointScale> scales =
      joint_scales(first_of(joints, models_of), trust, significance);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    RefineResult& r = joints[k];
    const auto own = std::find_if(r.effects.begin(), r.effects.end(),
                                  [](const NamedEffect& e) { return is_scale(e.instance); });
    if (own != r.effects.end())
      settle_scale(scales[k], *own, r);
    else if (scales[k].is_off() && r.not_refined.empty() && !torques.agreed.empty())
      add_torque_gain(scales[k], torques.agreed.front(), logs, r);
  }
}

}  // namespace cablefit
