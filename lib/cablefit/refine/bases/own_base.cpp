#include "cablefit/refine/bases/own_base.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/model_parameters.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/prove/model_to_simulate.hpp"
#include "cablefit/refine/rows/base_rows.hpp"
#include "cablefit/samples/survey/phases.hpp"

namespace cablefit {
namespace {

// Not the straight line, even where it will do for stage 1: a gap to be explained is smaller.
constexpr const char* kCables = "poly";
constexpr int kPlainOrder = 2;
constexpr double kAnyInertia = 1;  // kg m^2; a start value until the rows determine it

std::vector<EffectInstance> blank_effects(Side side, int joint, const Rig& rig) {
  return base_instances(side, joint, rig,
                        [](const Estimate& blank) { return std::optional(blank); });
}

Model blank_model(const std::string& preload, const Rig& rig, bool rigid) {
  Model model;
  model.preload = preload;
  model.rig = rig;
  model.rigid = rigid;
  for (int joint = 1; joint <= rig.n_joints(); ++joint) {
    JointModel& axes = model.joints.emplace_back();
    if (!rigid) axes.link = blank_effects(Side::link, joint, rig);
    axes.motor = blank_effects(rigid ? Side::rigid : Side::motor, joint, rig);
  }
  model.name = default_model_name(model);
  return model;
}

bool any_part(std::span<const LogSurvey> logs, const std::string& preload, Phase phase) {
  return std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return std::any_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& part) {
      return part.phase == phase && part.preload == preload;
    });
  });
}

/// Whether q is a copy of theta: both have the same ends in every part, to the last bit.
bool is_copied(std::span<const LogSurvey> logs) {
  return std::all_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return std::all_of(log.parts.begin(), log.parts.end(), [&](const PartSurvey& part) {
      const auto range = [&](Channel channel) {
        return seen_range(
            logs, [&](const PartSurvey& p) { return &p == &part; }, channel);
      };
      const ChannelRange q = range(Channel::q), theta = range(Channel::theta);
      return q.low == theta.low && q.high == theta.high && q.width() > 0;
    });
  });
}

void take_cables(const ElasticFit& fit, Model& model) {
  model.name = fit.model;
  model.transmission = fit.transmission;
  model.elastic = fit.parameters;
}

/// Lowest and highest order of the cables: stage 1 may choose one per cable.
std::pair<int, int> orders_of(const ElasticFit& fit) {
  const auto [least, most] =
      std::minmax_element(fit.transmission.cables.begin(), fit.transmission.cables.end(),
                          [](const Cable& a, const Cable& b) { return a.order < b.order; });
  return {least->order, most->order};
}

/// With the sd of l_o as they are where one was searched: refine adds them to its own.
ElasticResult stage1_of(std::span<const LogSurvey> logs, ElasticOptions options) {
  options.robust_sd = false;
  ElasticResult result = fit_elastic_stage(logs, options, ElongationMode::automatic);
  if (result.elongations.empty()) return result;
  options.robust_sd = true;
  return fit_elastic_stage(logs, options, ElongationMode::automatic);
}

/// Whether some preload has much larger errors in one result than in the other.
bool is_worse(const ElasticResult& one, const ElasticResult& other) {
  constexpr double kMuch = 1.5;
  return std::any_of(one.preloads.begin(), one.preloads.end(), [&](const ElasticPreload& preload) {
    return std::any_of(
        other.preloads.begin(), other.preloads.end(), [&](const ElasticPreload& same) {
          return same.name == preload.name &&
                 preload.find(kCables)->rms_error > kMuch * same.find(kCables)->rms_error;
        });
  });
}

/// Coefficients are shared between preloads, and a cable of a lower order than its neighbour would
/// be an effect to be found (stiffness_order): of different orders the highest for all. At most the
/// second order of the paper: a higher one is such an effect. Beside moving logs not less either: a
/// lower one may only say that the blocked sweep was short. Those of a rig file stand.
ElasticResult shared_stage1(std::span<const LogSurvey> logs, int threads) {
  ElasticOptions options;
  options.samples.threads = threads;
  ElasticResult result = stage1_of(logs, options);
  if (logs.front().plan.rig.cables_given) return result;
  int lowest = kMaxCableOrder, highest = 0;
  for (const ElasticPreload& preload : result.preloads) {
    const auto [least, most] = orders_of(*preload.find(kCables));
    lowest = std::min(lowest, least);
    highest = std::max(highest, most);
  }
  const bool any_moving = std::any_of(
      logs.begin(), logs.end(), [](const LogSurvey& log) { return has_phase(log, Phase::moving); });
  const int least = any_moving ? kPlainOrder : 1;
  if (lowest == highest && highest >= least && highest <= kPlainOrder) return result;
  options.order = std::clamp(highest, least, kPlainOrder);
  ElasticResult plain;
  try {
    plain = stage1_of(logs, options);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable || highest > kPlainOrder) throw;
    return result;
  }
  if (!plain.elongations.empty() || !is_worse(plain, result)) return plain;
  // A high order can imitate a preload, where both cables are taut; then only l_o explains order 2.
  try {
    options.robust_sd = true;
    ElasticResult searched = fit_elastic_stage(logs, options, ElongationMode::search);
    if (is_worse(plain, searched)) return searched;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
  }
  return plain;
}

std::vector<Estimate> arm_of(const DynamicFit& fit, const Rig& rig) {
  std::vector<Estimate> arm;
  for (const ParameterInfo& info : rig.arm.base_parameters()) {
    const Estimate* e = find_estimate(fit.parameters, info.name);
    if (e == nullptr || !std::isfinite(e->value))
      throw Error(ErrorKind::not_identifiable,
                  fmt::format("the moving logs do not determine {} of the arm", info.name));
    arm.push_back(*e);
  }
  return arm;
}

/// Coupled links are started from stage 2: no single joint determines their masses.
void take_arm(std::span<const LogSurvey> logs, const ElasticResult& stage1, int threads,
              std::vector<Model>& models, std::vector<Decision>& decisions) {
  std::vector<LogSurvey> moving;
  for (const LogSurvey& log : logs)
    if (has_phase(log, Phase::moving)) moving.push_back(log);
  if (moving.empty()) return;  // blocked logs alone show no mass
  DynamicOptions options;
  options.samples.threads = threads;
  options.estimator = "wls";
  options.robust_sd = false;
  for (const DynamicPreload& preload : fit_dynamic(moving, stage1, options).preloads)
    for (Model& model : models) {
      if (preload.name != model.preload) continue;
      const DynamicFit& fit = preload.fits.front();
      std::string not_asked;  // the arm is taken apart from it
      model.joints = model_to_simulate(fit, preload, model.rig, not_asked).joints;
      model.arm = arm_of(fit, model.rig);
    }
  decisions.push_back({"arm", "base parameters", "stage 2, from the moving logs"});
}

void take_stage1(std::span<const LogSurvey> logs, int threads, OwnBase& base) {
  std::vector<Model>& models = base.models;
  const ElasticResult stage1 = shared_stage1(logs, threads);
  base.elongations = stage1.elongations;
  for (Model& model : models)
    for (const ElasticPreload& preload : stage1.preloads)
      if (preload.name == model.preload) take_cables(*preload.find(kCables), model);
  base.decisions.push_back({kCablesChoice, kCables, "stage 1, from the blocked logs"});
  if (models.front().rig.arm.is_coupled()) take_arm(logs, stage1, threads, models, base.decisions);
}

void add_start_springs(Model& model) {
  const int n = model.rig.n_joints();
  for (int joint = 1; joint <= n; ++joint) {
    Estimate& e = model.elastic.emplace_back();
    e.name = e.symbol = joint_parameter_name(kSpringName, joint, n);
    e.unit = unit_for(model.rig.axes.of(joint - 1), "N m/rad");
    e.not_identifiable = kStartValue;
  }
}

/// One straight spring, whose stiffness the rows determine.
void take_spring(std::vector<Model>& models) {
  for (Model& model : models) {
    model.name = "linear";
    const auto n = static_cast<Eigen::Index>(model.joints.size());
    model.transmission = classical_spring(model.transmission);
    model.transmission.linear_stiffness = Eigen::VectorXd::Ones(n);
    model.transmission.theta_0 = Eigen::VectorXd::Zero(n);
    add_start_springs(model);
  }
}

void use_spring(OwnBase& base, const std::string& why) {
  take_spring(base.models);
  base.elongations = {};
  std::erase_if(base.decisions, [](const Decision& d) { return d.name == kCablesChoice; });
  base.decisions.push_back({kCablesChoice, "a straight spring", why});
}

void take_one_step(std::span<const LogSurvey> logs, int threads, OwnBase& base) {
  IdentifyOptions options;
  options.samples.threads = threads;
  options.robust_sd = false;
  IdentifyResult found = identify(logs, options);
  if (!found.elongations.empty()) {
    options.robust_sd = true;
    found = identify(logs, options);
  }
  base.elongations = found.elongations;
  for (Model& model : base.models)
    for (const IdentifyPreload& preload : found.preloads)
      if (preload.name == model.preload) {
        model.name = kCables;
        model.transmission = preload.transmission;
      }
  base.decisions.push_back(
      {kCablesChoice, kCables, "one step, from the moving logs: no link is blocked"});
}

/// An inertia that the rig file gives is not fitted.
void take_given_inertia(Model& model) {
  const std::vector<double>& given = model.rig.arm.parameters.J_link;
  if (model.rigid || given.empty()) return;
  for (std::size_t k = 0; k < model.joints.size(); ++k)
    for (EffectInstance& instance : model.joints[k].link)
      if (instance.effect->is_inertia()) instance.parameters.front().value = given[k];
}

/// "J_link = 0.3 (cad)", or empty: there was a value.
std::string fill(const Rig& rig, bool is_inertia, const ParameterInfo& info, Estimate& e) {
  const bool is_there = std::isfinite(e.value) && !(is_inertia && e.value <= 0);
  if (is_there) return "";
  const auto cad = rig.cad.find(e.name);
  const bool has_cad = cad != rig.cad.end() && (!is_inertia || cad->second > 0);
  e.value = has_cad                     ? cad->second
            : is_inertia                ? kAnyInertia
            : std::isfinite(info.lower) ? info.lower
                                        : 0;
  e.not_identifiable = kStartValue;
  return e.name + (has_cad ? " (CAD)" : "");
}

}  // namespace

OwnBase own_base(const RefineLogs& logs, int threads) {
  OwnBase base;
  const std::vector<LogSurvey> fitted = logs.fitted();
  const std::vector<std::string> names =
      preload_names(fitted, [](const PartSurvey& /*part*/) { return true; });
  const bool has_both = std::any_of(fitted.begin(), fitted.end(), [](const LogSurvey& log) {
    return log.plan.has(Channel::q) && log.plan.has(Channel::theta);
  });
  const bool rigid = !has_both || is_copied(fitted);
  bool all_blocked = true;
  for (const std::string& name : names) {
    const Rig& rig = first_log_with(fitted, [&](const PartSurvey& part) {
                       return part.preload == name;
                     }).plan.rig;
    if (!rigid) refuse_searched_radius(rig, "refine");
    base.models.push_back(blank_model(name, rig, rigid));
    all_blocked = all_blocked && any_part(fitted, name, Phase::blocked);
  }
  if (rigid)
    base.decisions.push_back({"base", "a rigid drive",
                              has_both ? "q is a copy of theta" : "no log has both q and theta"});
  else if (all_blocked)
    take_stage1(fitted, threads, base);
  else if (base.models.front().rig.arm.is_coupled())
    throw Error(ErrorKind::not_identifiable,
                "links that move each other are refined beside blocked logs; give a log with the "
                "links blocked, or a model");
  else
    try {
      take_one_step(fitted, threads, base);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_identifiable) throw;
      use_spring(base, error.what());
    }
  (void)fill_start_values(base.models);  // all of them: nothing to say
  return base;
}

OwnBase with_spring(OwnBase base, const std::string& why) {
  use_spring(base, why);
  return base;
}

std::vector<Decision> fill_start_values(std::vector<Model>& models) {
  std::vector<Decision> decisions;
  for (Model& model : models) {
    take_given_inertia(model);
    std::string filled;
    for (JointModel& axes : model.joints)
      for (auto* effects : {&axes.link, &axes.motor})
        for (EffectInstance& instance : *effects)
          for (std::size_t k = 0; k < instance.parameters.size(); ++k) {
            const std::string name = fill(model.rig, instance.effect->is_inertia(),
                                          instance.effect->parameters[k], instance.parameters[k]);
            if (!name.empty()) filled += (filled.empty() ? "" : ", ") + name;
          }
    if (!filled.empty())
      decisions.push_back({fmt::format("start values of preload '{}'", model.preload), filled,
                           "the model has no value; refine estimates it"});
  }
  return decisions;
}

}  // namespace cablefit
