#include "cablefit/refine/torque_gains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/bases/kept_joint.hpp"
#include "cablefit/refine/scaled_torque.hpp"
#include "cablefit/refine/shared_gap.hpp"
#include "cablefit/refine/verdict/conclusion.hpp"

namespace cablefit {
namespace {

constexpr std::string_view kScaleClass = "scale";
// A load checks a torque where it is above the noise of its sensor and a part of the torque.
constexpr double kAboveNoise = 20, kPartOfTorque = 0.05;
// Factors of torque and load that are one: sd, and what no sd contains.
constexpr double kSameGainSd = 4, kSameFactor = 0.01;

const Effect& torque_gain() { return find_candidate("torque_gain", Site::drive); }
const Effect& load_scale() { return find_candidate("load_scale", Site::link); }

bool any_off(const std::vector<JointScale>& scales) {
  return std::any_of(scales.begin(), scales.end(), [](const JointScale& s) { return s.is_off(); });
}

double largest(const ChannelSurvey& channel) {
  return std::max(std::abs(channel.min), std::abs(channel.max));
}

/// Whether a log has a load that checks the torque of the joint (from 0).
bool is_loaded(const RefineLogs& logs, int joint) {
  const std::vector<LogSurvey> fitted = logs.fitted();
  return std::any_of(fitted.begin(), fitted.end(), [&](const LogSurvey& log) {
    const int load = log.plan.find(Channel::tau_load, joint);
    const int torque = log.plan.find(Channel::tau, joint);
    if (load < 0 || torque < 0) return false;
    return std::any_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& part) {
      const ChannelSurvey& of_load = part.channels[static_cast<std::size_t>(load)];
      const ChannelSurvey& of_torque = part.channels[static_cast<std::size_t>(torque)];
      return largest(of_load) > kAboveNoise * std::max(of_load.noise, of_load.quantum) &&
             largest(of_load) > kPartOfTorque * largest(of_torque);
    });
  });
}

/// Whether two joints have a cable or masses in common.
bool shares_anything(const Model& model) {
  if (model.rigid) return false;
  const std::vector<Cable>& cables = model.transmission.cables;
  return model.is_coupled() || std::any_of(cables.begin(), cables.end(), [&](const Cable& cable) {
           int n = 0;
           for (std::size_t joint = 0; joint < model.joints.size(); ++joint)
             n += cable.passes(joint) ? 1 : 0;
           return n > 1;
         });
}

std::vector<TorqueTrust> trust_by_loads(const RefineLogs& logs, std::size_t n_joints) {
  std::vector<TorqueTrust> trust;
  for (std::size_t joint = 0; joint < n_joints; ++joint)
    trust.push_back(is_loaded(logs, static_cast<int>(joint)) ? TorqueTrust::confirmed
                                                             : TorqueTrust::unknown);
  return trust;
}

bool is_scale(const EffectInstance& instance) {
  return instance.effect->alias_class == kScaleClass;
}

NamedEffect* own_scale(RefineResult& r) {
  const auto own = std::find_if(r.effects.begin(), r.effects.end(), [](const NamedEffect& effect) {
    return is_scale(effect.instance);
  });
  return own == r.effects.end() ? nullptr : &*own;
}

/// a = 1 - factor. `scale` may be nullptr: without sd.
EffectInstance instance_of(const Effect& row, double factor, const JointScale* scale) {
  EffectInstance instance{&row, {}};
  Estimate& a = instance.parameters.emplace_back();
  a.name = row.parameters.front().name;
  a.symbol = row.parameters.front().symbol;
  a.value = 1 - factor;
  if (scale == nullptr) return instance;
  a.sd = scale->sd;
  set_interval(a, scale->dof);
  return instance;
}

std::vector<Rival> rivals_of(const JointScale& scale, const Effect& row) {
  std::vector<Rival> rivals;
  for (const int joint : scale.rivals) {
    Rival& rival = rivals.emplace_back();
    rival.name = row.name;
    rival.side = to_string(row.site);
    rival.gain = 1;
    rival.experiment = row.experiment;
    rival.joint = joint + 1;
  }
  return rivals;
}

TorqueFactor to_others(const JointScale& scale) {
  return {1 / scale.scale, scale.sd / scale.scale};
}

/// Of all joints, links and cables in the torque of those that agree. `own`: of each joint its
/// models, one per preload.
template <typename Models>
std::vector<Model> agreed_models(std::size_t n_preloads, const std::vector<JointScale>& scales,
                                 Models own) {
  std::vector<Model> agreed;
  for (std::size_t m = 0; m < n_preloads; ++m) {
    std::vector<Model> joints;
    for (std::size_t k = 0; k < scales.size(); ++k)
      joints.push_back(with_link_torque(own(k, m), {1 / scales[k].scale, 0}));
    agreed.push_back(joined(joints));
  }
  return agreed;
}

/// The gap before is that with the others' values.
void widen_before(const SharedGap& gap, RefineResult& r) {
  const auto with = [](double before, double after, double ratio) {
    return std::sqrt(before * before + std::max(0.0, ratio - 1) * after * after);
  };
  r.rho_before += std::max(0.0, gap.train - 1) * r.rho_after;
  r.torque.train_before = with(r.torque.train_before, r.torque.train_after, gap.train);
  for (std::size_t i = 0; i < 2; ++i)
    r.torque.test_before_ci[i] =
        with(r.torque.test_before_ci[i], r.torque.test_after_ci[i], gap.test);
  r.torque.test_before = with(r.torque.test_before, r.torque.test_after, gap.test);
}

void forget(const EffectInstance& gone, ParameterCovariance& covariance) {
  const std::string name = added_parameter_name(*gone.effect, gone.effect->parameters.front());
  std::vector<Eigen::Index> kept;
  std::vector<std::string> names;
  for (std::size_t k = 0; k < covariance.parameters.size(); ++k) {
    if (covariance.parameters[k].starts_with(name)) continue;
    kept.push_back(static_cast<Eigen::Index>(k));
    names.push_back(covariance.parameters[k]);
  }
  if (names.size() == covariance.parameters.size()) return;
  covariance.matrix = covariance.matrix(kept, kept).eval();
  covariance.parameters = std::move(names);
}

/// Scales the result to the torque of the other joints, but for the motor. `instead` replaces an
/// effect of the same class.
void take_scale(const JointScale& scale, const EffectInstance& instead, RefineResult& r) {
  const TorqueFactor factor = to_others(scale);
  for (ParameterShift& shift : r.shifts) {
    if (is_of_motor(r.models.front(), shift.name)) continue;
    Estimate after;
    after.unit = shift.unit;
    after.value = shift.after;
    after.sd = shift.sd;
    factor.scale(after);
    shift.after = after.value;
    shift.sd = after.sd;
  }
  const auto scale_effect = [&](NamedEffect& effect) {
    if (is_of_motor(*effect.instance.effect) || is_scale(effect.instance)) return;
    for (auto* estimates : {&effect.instance.parameters, &effect.derived})
      for (Estimate& e : *estimates) factor.scale(e);
    effect.torque_rms *= factor.value;
  };
  for (NamedEffect& effect : r.effects) scale_effect(effect);
  for (KeptEffect& kept : r.kept) scale_effect(kept.now);
  for (Model& model : r.models) {
    std::vector<EffectInstance>& added = model.joints.front().added;
    for (const EffectInstance& instance : added)
      if (is_scale(instance)) forget(instance, model.covariance);
    std::erase_if(added, is_scale);
    model = with_link_torque(std::move(model), factor);
    model.joints.front().added.push_back(instead);
  }
}

void add_torque_gain(const JointScale& scale, const Model& agreed, const RefineLogs& logs,
                     RefineResult& r) {
  const SharedGap gap = shared_gap(r.models, one_joint(agreed, r.joint - 1), logs);
  NamedEffect effect;
  effect.instance = instance_of(torque_gain(), scale.scale, &scale);
  effect.joint = r.joint;
  effect.torque_rms = std::abs(1 - 1 / scale.scale) * gap.elastic_torque;
  effect.rivals = rivals_of(scale, torque_gain());
  effect.evidence.gain = gap.test > 1 ? 1 - 1 / gap.test : 0;
  effect.evidence.rho_before = gap.train * r.rho_after;
  effect.evidence.rho_after = r.rho_after;
  effect.evidence.p_value = scale.chance;
  effect.evidence.inclusion = std::numeric_limits<double>::quiet_NaN();
  widen_before(gap, r);
  take_scale(scale, effect.instance, r);
  const std::string reason = fmt::format(
      "the values that it shares with other joints are {:.4g} times as large (sd {:.1g}, {} "
      "values)",
      scale.scale, scale.sd, scale.n);
  r.reason = r.effects.empty() && r.verdict == Verdict::none ? reason : r.reason + "; " + reason;
  if (!effect.rivals.empty()) {
    r.next_experiment = torque_gain().experiment;
    r.next_run.reset();
  }
  r.effects.push_back(std::move(effect));
  r.verdict = verdict_by_rivals(r);
}

/// A wrong torque and a wrong load are not separable with one joint. With the right one of the two
/// the joint's values agree with those of the others.
void decide_scale(const JointScale& scale, NamedEffect& own, RefineResult& r) {
  if (!scale.comparable) return;
  if (scale.is_off()) {
    const Estimate& a = own.instance.parameters.front();
    const double one = std::abs(std::log(scale.scale * (1 - a.value)));
    if (!(one < kSameFactor + kSameGainSd * std::hypot(scale.sd / scale.scale, a.sd))) {
      r.warnings.push_back(fmt::format(
          "the values that it shares with other joints are {:.4g} times as large; neither a "
          "wrong torque nor a wrong load alone explains that; check both",
          scale.scale));
      return;
    }
    const Effect& other = own.instance.effect->site == Site::drive ? load_scale() : torque_gain();
    own.instance = instance_of(other, scale.scale, &scale);
    take_scale(scale, own.instance, r);
  }
  std::erase_if(own.rivals, [](const Rival& rival) { return rival.by_rule; });
  if (r.next_experiment.starts_with(own.instance.effect->experiment)) r.next_experiment.clear();
  if (r.verdict == Verdict::ambiguous) r.verdict = verdict_by_rivals(r);
}

}  // namespace

std::vector<Model> without_shown_gains(std::span<const Model> given, const RefineLogs& logs) {
  std::vector<Model> models(given.begin(), given.end());
  for (Model& model : models)
    for (std::size_t k = 0; k < model.joints.size(); ++k) {
      if (is_loaded(logs, static_cast<int>(k))) continue;
      for (const EffectInstance& instance : model.joints[k].added)
        if (instance.effect == &torque_gain()) forget(instance, model.covariance);
      std::erase_if(model.joints[k].added, [](const EffectInstance& instance) {
        return instance.effect == &torque_gain();
      });
    }
  return models;
}

ComparedTorques compared_torques(const std::vector<Model>& models, const RefineLogs& logs,
                                 double significance) {
  const std::size_t n = models.front().joints.size();
  if (!shares_anything(models.front())) return {std::vector<JointScale>(n), {}};
  std::vector<std::vector<Model>> fits;
  std::vector<const Model*> first;
  for (std::size_t k = 0; k < n; ++k)
    fits.push_back(base_estimates(one_joint(models, static_cast<int>(k)), logs)
                       .value_or(std::vector<Model>{}));
  for (const std::vector<Model>& fit : fits) first.push_back(fit.empty() ? nullptr : &fit.front());
  ComparedTorques torques;
  torques.scales = joint_scales(first, trust_by_loads(logs, n), significance);
  if (any_off(torques.scales))
    torques.agreed =
        agreed_models(models.size(), torques.scales, [&](std::size_t k, std::size_t m) {
          return fits[k].empty() ? one_joint(models[m], static_cast<int>(k)) : fits[k][m];
        });
  return torques;
}

std::vector<Model> start_of(int joint, std::span<const Model> models,
                            const ComparedTorques& torques) {
  if (torques.agreed.empty()) return one_joint(models, joint);
  const double own = torques.scales[static_cast<std::size_t>(joint)].scale;
  std::vector<Model> start;
  for (const Model& agreed : torques.agreed) {
    Model& model = start.emplace_back(with_link_torque(agreed, {own, 0}));
    for (std::size_t k = 0; k < model.joints.size(); ++k)
      if (torques.scales[k].scale != own)
        model.joints[k].added.push_back(
            instance_of(torque_gain(), torques.scales[k].scale / own, nullptr));
  }
  return one_joint(start, joint);
}

void name_torque_gains(const RefineLogs& logs, double significance,
                       std::vector<RefineResult>& joints) {
  std::vector<TorqueTrust> trust = trust_by_loads(logs, joints.size());
  std::vector<const Model*> models;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (own_scale(joints[k]) != nullptr) trust[k] = TorqueTrust::contradicted;
    const bool is_known = joints[k].not_refined.empty() && !joints[k].models.empty();
    models.push_back(is_known ? &joints[k].models.front() : nullptr);
  }
  const std::vector<JointScale> scales = joint_scales(models, trust, significance);
  std::vector<Model> agreed;
  if (any_off(scales))
    agreed = agreed_models(1, scales,
                           [&](std::size_t k, std::size_t m) { return joints[k].models.at(m); });
  for (std::size_t k = 0; k < joints.size(); ++k) {
    RefineResult& r = joints[k];
    if (NamedEffect* own = own_scale(r))
      decide_scale(scales[k], *own, r);
    else if (scales[k].is_off())
      add_torque_gain(scales[k], agreed.front(), logs, r);
  }
}

}  // namespace cablefit
