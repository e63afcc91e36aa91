// cablefit/dynamic/1 as a model: one fit of one preload.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "cablefit/base/quote.hpp"
#include "cablefit/dynamic/fit_model.hpp"
#include "cablefit/dynamic/rows/delay_hold.hpp"
#include "cablefit/model/assembled_model.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/results/read/dynamic_reader.hpp"
#include "cablefit/results/read/fit_reader.hpp"
#include "cablefit/results/result_models.hpp"

namespace cablefit::result_file {
namespace {

constexpr std::string_view kPreferredModel = "poly";  // the paper's own; docs/reference/commands.md

/// Its rig, with what stage 2 found out about the torque column unless the rig file knew.
Rig rig_of(const JsonNode& node, const DynamicPreload& preload) {
  Rig rig = model_file::read_rig_reference(node.find("rig"));
  if (node.find("torque_delay") != nullptr && rig.torque_hold == TorqueHold::automatic)
    set_torque_hold(preload.delay, rig);
  return rig;
}

/// A one-step fit lists the elastic parameters among the others.
void take_own_curve(const JsonNode& node, const Rig& rig, DynamicFit& fit) {
  if (fit.elastic || is_rigid_fit(fit, rig)) return;
  ElasticFit& curve = fit.elastic.emplace();
  curve.parameters = fit.parameters;
  read_curve(node, rig, {&node, "add the \"elastic\" object of stage 1 to the fit"}, curve);
  curve.parameters = elastic_estimates(curve.transmission, rig, [&](const Estimate& blank) {
    const Estimate* e = find_estimate(fit.parameters, blank.name);
    return e == nullptr ? std::nullopt : std::optional(*e);
  });
}

/// The parameters of the model's equations by their names in results.
std::vector<Estimate> parameters_of(const Model& model) {
  std::vector<Estimate> all = model.arm;
  const auto n_joints = static_cast<int>(model.joints.size());
  for (int joint = 0; joint < n_joints; ++joint) {
    const JointModel& axes = model.joints[static_cast<std::size_t>(joint)];
    for (const auto* side : {&axes.link, &axes.motor})
      for (const EffectInstance& effect : *side)
        all.insert(all.end(), effect.parameters.begin(), effect.parameters.end());
    for (const EffectInstance& effect : axes.added)
      for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        all.push_back(effect.parameters[k]);
        all.back().name =
            added_parameter_name(*effect.effect, effect.effect->parameters[k], joint, n_joints);
      }
  }
  return all;
}

/// Every parameter of the fit is one of the model, in a unit of its kind.
void require_known(const JsonNode& list, const std::vector<Estimate>& known) {
  for (const JsonNode& item : list.items) {
    const std::string& name = item.at("name").text();
    const Estimate* e = find_estimate(known, name);
    if (e == nullptr)
      throw item.error(fmt::format("parameter {} belongs to no effect", in_quotes(name)),
                       "see `cablefit list effects`");
    (void)model_file::read_estimate(item, name, e->symbol, e->unit);
  }
}

bool is_inertia(const Estimate& e) {
  const std::span<const Effect> rows = base_effects();
  return std::any_of(rows.begin(), rows.end(), [&](const Effect& row) {
    return row.is_inertia() && e.symbol == row.parameters.front().symbol;
  });
}

/// A model that moves needs the inertias, which the fit may not have determined.
void require_determined_inertias(const DynamicFit& fit, const JsonNode& node) {
  for (const Estimate& e : fit.parameters)
    if (is_inertia(e) && !e.not_identifiable.empty())
      throw node.error(
          fmt::format("{} is not identifiable in this fit: {}", e.name, e.not_identifiable),
          "'cablefit identify' of the same logs may determine it");
}

}  // namespace

Model read_dynamic_model(const JsonNode& root, const model_file::Wanted& wanted,
                         std::string* choice) {
  const JsonNode& preloads = root.at("preloads");
  const JsonNode& preload_node = pick(preloads, "name", wanted.preload, "");
  const JsonNode& fits = preload_node.at("fits");
  const JsonNode& fit_node = pick(fits, "model", wanted.model, kPreferredModel);
  const DynamicPreload preload = read_dynamic_preload(preload_node);
  const Rig rig = rig_of(preload_node, preload);
  DynamicFit fit = read_dynamic_fit(fit_node, &rig);
  const bool in_one_step = !fit.elastic;
  take_own_curve(fit_node, rig, fit);
  Model model = model_of(fit, preload, rig);
  std::vector<Estimate> known = parameters_of(model);
  if (in_one_step) known.insert(known.end(), model.elastic.begin(), model.elastic.end());
  require_known(fit_node.at("parameters"), known);
  if (wanted.completeness == Completeness::can_move) {
    require_determined_inertias(fit, fit_node);
    model_file::require_inertia(model, fit_node);
  }
  *choice = describe(preloads, preload_node, "preload", "name", wanted.preload) + ", " +
            describe(fits, fit_node, "model", "model", wanted.model);
  return model;
}

}  // namespace cablefit::result_file
