// cablefit/dynamic/1 as a model: one fit of one preload.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/file/fit_parameters.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {
namespace {

constexpr std::string_view kPreferredModel = "poly";  // the paper's own; docs/reference/commands.md

/// The item whose `key` is `wanted`; when nothing is wanted the preferred or else the first one.
const JsonNode& pick(const JsonNode& list, std::string_view key, std::string_view wanted,
                     std::string_view preferred) {
  if (wanted.empty()) {
    const JsonNode* item = find_item(list, key, preferred);
    return item ? *item : list.items.front();
  }
  if (const JsonNode* item = find_item(list, key, wanted)) return *item;
  std::vector<std::string_view> known;
  for (const JsonNode& item : list.items) known.push_back(item.at(key).text());
  fail_unknown(list, key == "name" ? "preload" : key, wanted, known);
}

/// "preload 'low' (of low, high)": what was taken, and the others when nobody had asked.
std::string describe(const JsonNode& list, const JsonNode& taken, std::string_view what,
                     std::string_view key, std::string_view wanted) {
  std::string text = fmt::format("{} '{}'", what, taken.at(key).text());
  if (!wanted.empty() || list.items.size() < 2) return text;
  std::string others;
  for (const JsonNode& item : list.items) {
    others += (others.empty() ? "" : ", ") + item.at(key).text();
  }
  return fmt::format("{} (of {})", text, others);
}

Estimate take(const JsonNode& node, const Estimate& blank) {
  return read_estimate(node, blank.name, blank.symbol, blank.unit);
}

std::vector<EffectInstance> take_effects(FitParameters* parameters, Side side, int joint,
                                         const Model& model) {
  return base_instances(side, joint, model.rig, [&](const Estimate& blank) {
    const JsonNode* node = parameters->find_dynamic(blank.name);
    return node == nullptr ? std::nullopt : std::optional(take(*node, blank));
  });
}

void take_coefficients(FitParameters* parameters, Cable* cable, Model* model) {
  const bool cable_space = model->rig.cables_given;
  cable->coefficients.clear();
  for (int j = 0; j < cable->n_coefficients(); ++j) {
    const std::string name = coefficient_name(*cable, j, cable_space);
    std::string unit = coefficient_unit(*cable->law, j, cable_space);
    if (model->rig.linear_motion && !cable_space) unit = linear_unit(unit);
    model->elastic.push_back(read_estimate(parameters->at_elastic(name), name, name, unit));
    const double value = model->elastic.back().value;
    cable->coefficients.push_back(std::isnan(value) ? 0 : value);  // never pulled: slack
  }
}

void take_elongation(FitParameters* parameters, Cable* cable, Model* model) {
  const std::string name = elongation_name(*cable);
  const JsonNode* node = parameters->find_elastic(name);
  if (!node) return;
  std::string unit(elongation_unit(model->rig.cables_given));
  if (model->rig.linear_motion && !model->rig.cables_given) unit = linear_unit(unit);
  model->elastic.push_back(read_estimate(*node, name, name, unit));
  cable->initial_elongation = model->elastic.back().value;
}

/// As many coefficients as the file has for this cable; orders differ between cables.
void take_order(FitParameters* parameters, bool cable_space, Cable* cable) {
  int count = 0;
  while (count < kMaxCableOrder &&
         parameters->find_elastic(coefficient_name(*cable, count, cable_space)))
    ++count;
  if (count == 0) return;  // told by name when the first coefficient is read
  cable->order = 1;
  while (cable->order < cable->law->max_order && cable->n_coefficients() < count) ++cable->order;
}

void take_cables(FitParameters* parameters, Model* model) {
  for (Cable& cable : model->transmission.cables) {
    take_order(parameters, model->rig.cables_given, &cable);
    take_coefficients(parameters, &cable, model);
  }
  for (Cable& cable : model->transmission.cables) take_elongation(parameters, &cable, model);
}

void take_linear_stiffness(FitParameters* parameters, Model* model) {
  const int n = model->rig.n_joints();
  model->transmission = classical_spring(model->transmission);
  for (int k = 0; k < n; ++k) {
    const std::string name = joint_parameter_name("K", k + 1, n);
    model->elastic.push_back(
        read_estimate(parameters->at_elastic(name), name, name, stiffness_unit(model->rig)));
    model->transmission.linear_stiffness[k] = model->elastic.back().value;
  }
}

/// What stage 1 found besides, for information.
void take_other_results(const JsonNode& elastic, Model* model) {
  for (const JsonNode& item : some_items(elastic.at("parameters"))) {
    const std::string& name = item.at("name").text();
    if (find_estimate(model->elastic, name)) continue;
    const std::string unit = text_or(item, "unit", "");
    model->elastic.push_back(read_estimate(item, name, name, unit));
  }
}

void take_transmission(FitParameters* parameters, Model* model) {
  const int n = model->rig.n_joints();
  model->transmission = model->rig.transmission;
  if (parameters->find_elastic(joint_parameter_name("K", 1, n))) {
    take_linear_stiffness(parameters, model);
  } else {
    take_cables(parameters, model);
  }
  const JsonNode* elastic = parameters->elastic();
  if (!elastic) return;
  const JsonNode* zero = elastic->find("theta_0");
  if (zero && !zero->is_null()) {
    const std::vector<double> values = n_numbers(*zero, n);
    model->transmission.theta_0 = Eigen::Map<const Eigen::VectorXd>(values.data(), n);
  }
  take_other_results(*elastic, model);
}

/// What stage 2 found out about the torque column, unless the rig file knew.
void take_torque_hold(const JsonNode& preload, Rig* rig) {
  const JsonNode* delay = preload.find("torque_delay");
  if (!delay || rig->torque_hold != TorqueHold::automatic) return;
  rig->torque_hold = delay->at("held").boolean() ? TorqueHold::zoh : TorqueHold::none;
}

/// "effects" of a fit: what it has beyond the paper's. They stand among its parameters as well.
void take_added(const JsonNode& fit, FitParameters* parameters, Model* model) {
  const JsonNode* effects = fit.find("effects");
  if (effects == nullptr || effects->items.empty()) return;
  std::vector<EffectInstance>& added = model->joints.front().added;
  added = read_refinements(*effects, *model);
  for (const EffectInstance& effect : added)
    for (const ParameterInfo& info : effect.effect->parameters)
      (void)parameters->find_dynamic(added_parameter_name(*effect.effect, info));
}

/// All of them or, of a rigid drive, none.
void take_arm(FitParameters* parameters, Model* model) {
  for (const ParameterInfo& info : model->rig.arm.base_parameters()) {
    const JsonNode* node = parameters->find_dynamic(info.name);
    if (node == nullptr) return model->arm.clear();
    model->arm.push_back(
        read_estimate(*node, std::string(info.name), info.symbol, unit_on(model->rig, info.unit)));
  }
}

void take_joints(FitParameters* parameters, Model* model) {
  const int n = model->rig.n_joints();
  const std::string_view rigid_name = base_effects(Side::rigid).front().parameters.front().name;
  model->rigid = parameters->find_dynamic(joint_parameter_name(rigid_name, 1, n)) != nullptr;
  const Side motor = model->rigid ? Side::rigid : Side::motor;
  for (int joint = 1; joint <= n; ++joint) {
    JointModel& axes = model->joints.emplace_back();
    if (!model->rigid) axes.link = take_effects(parameters, Side::link, joint, *model);
    axes.motor = take_effects(parameters, motor, joint, *model);
  }
}

std::vector<WindowMean> link_residual(const JsonNode& preload, const std::string& model) {
  std::vector<WindowMean> means;
  const JsonNode* tests = preload.find("residual_tests");
  if (tests == nullptr) return means;
  for (const JsonNode& item : tests->items) {
    const JsonNode* list = item.find("residual_means");
    if (list == nullptr || item.at("model").text() != model ||
        item.at("equation").text() != to_string(Side::link))
      continue;
    for (const JsonNode& mean : list->items)
      means.push_back({mean.at("seconds").positive(), mean.at("sd").number()});
  }
  return means;
}

}  // namespace

Model read_result_file(const JsonNode& root, const Wanted& wanted, std::string* choice) {
  const JsonNode& preloads = root.at("preloads");
  const JsonNode& preload = pick(preloads, "name", wanted.preload, "");
  const JsonNode& fits = preload.at("fits");
  const JsonNode& fit = pick(fits, "model", wanted.model, kPreferredModel);
  Model model;
  model.name = fit.at("model").text();
  model.preload = preload.at("name").text();
  model.rig = read_rig_reference(preload.find("rig"));
  take_torque_hold(preload, &model.rig);
  FitParameters parameters(fit);
  take_arm(&parameters, &model);
  take_joints(&parameters, &model);
  take_added(fit, &parameters, &model);
  if (!model.rigid) take_transmission(&parameters, &model);
  parameters.require_all_used();
  if (wanted.completeness == Completeness::can_move) require_inertia(model, fit);
  model.link_residual = link_residual(preload, model.name);
  const JsonNode* covariance = fit.find("covariance");
  if (covariance != nullptr && !covariance->is_null())
    model.covariance = read_covariance(*covariance);
  *choice = describe(preloads, preload, "preload", "name", wanted.preload) + ", " +
            describe(fits, fit, "model", "model", wanted.model);
  return model;
}

}  // namespace cablefit::model_file
