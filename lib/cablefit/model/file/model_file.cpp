// cablefit/model/1, the file people write by hand.
#include <fmt/core.h>

#include <algorithm>

#include "cablefit/base/quote.hpp"
#include "cablefit/model/file/parts.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::model_file {
namespace {

EffectInstance read_effect(const std::string& name, const JsonNode& node, Side side, int joint,
                           const Rig& rig) {
  EffectInstance instance;
  instance.effect = at_place_of(node, [&] { return &find_base_effect(name, side); });
  std::vector<std::string_view> known;
  for (const ParameterInfo& parameter : instance.effect->parameters) {
    const JsonNode& value = node.at(parameter.name);
    const Estimate blank = blank_estimate(parameter, joint, rig);
    instance.parameters.push_back(
        read_strict_estimate(value, blank.name, blank.symbol, blank.unit));
    known.push_back(parameter.name);
  }
  for (const auto& [key, value] : node.members) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      fail_unknown(value, "parameter", key, known);
    }
  }
  return instance;
}

std::vector<EffectInstance> read_side(const JsonNode& node, Side side, int joint, const Rig& rig) {
  std::vector<EffectInstance> effects;
  for (const auto& [name, value] : members_of(node)) {
    effects.push_back(read_effect(name, value, side, joint, rig));
  }
  return effects;
}

/// {"name", "link", "motor", "refinements"}, or {"name", "rigid", "refinements"} on a drive without
/// elasticity.
JointModel read_joint(const JsonNode& node, int joint, const Model& model) {
  node.allow_only({"name", "link", "motor", "rigid", "refinements"});
  const std::string& expected = model.rig.joints[static_cast<std::size_t>(joint) - 1];
  if (text_or(node, "name", expected) != expected) {
    throw node.at("name").error(fmt::format("joint {}", in_quotes(node.at("name").text())),
                                fmt::format("the rig calls it '{}'", expected));
  }
  JointModel axes;
  if (model.rigid) {
    node.allow_only({"name", "rigid", "refinements"});
    axes.motor = read_side(node.at("rigid"), Side::rigid, joint, model.rig);
  } else {
    node.allow_only({"name", "link", "motor", "refinements"});
    axes.link = read_side(node.at("link"), Side::link, joint, model.rig);
    axes.motor = read_side(node.at("motor"), Side::motor, joint, model.rig);
  }
  if (const JsonNode* refinements = node.find("refinements"))
    axes.added = read_refinements(*refinements, model.rig.axes.of(joint - 1), model.rigid);
  return axes;
}

void read_joints(const JsonNode& node, Model* model) {
  const std::vector<JsonNode>& joints = some_items(node);
  if (joints.size() != model->rig.joints.size()) {
    throw node.error(fmt::format("{} joint(s)", joints.size()),
                     fmt::format("the rig has {}", model->rig.n_joints()));
  }
  model->rigid = joints.front().find("rigid") != nullptr;
  for (const JsonNode& joint : joints) {
    const int number = static_cast<int>(model->joints.size()) + 1;
    model->joints.push_back(read_joint(joint, number, *model));
  }
}

/// The links of a coupled arm have its base parameters instead of inertias.
void require_one_inertia(const Model& model, const JsonNode& root) {
  if (!model.is_coupled()) return;
  const std::vector<JsonNode>& joints = root.at("joints").items;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (model.rigid)
      throw root.at("arm").error("a rigid drive has no base parameters",
                                 "drop \"arm\", or give every joint a link and a motor");
    if (const JsonNode* inertia = joints[k].at("link").find("inertia"))
      throw inertia->error("a link of a coupled arm has no inertia of its own",
                           "drop it: the base parameters in \"arm\" hold it");
  }
}

/// "elastic": what else stage 1 found, for information.
void read_other_results(const JsonNode& node, Model* model) {
  for (const JsonNode& item : some_items(node)) {
    const std::string& name = item.at("name").text();
    model->elastic.push_back(read_estimate(item, name, name, item.at("unit").text()));
  }
}

void require_wanted(const JsonNode& root, std::string_view what, const std::string& given,
                    const std::string& wanted) {
  if (wanted.empty() || wanted == given) return;
  throw root.error(fmt::format("this is the model file of {} '{}'", what, given),
                   fmt::format("'{}' was asked for", wanted));
}

}  // namespace

Model read_model_file(const JsonNode& root, const Wanted& wanted, std::string* choice) {
  root.allow_only({"schema", "name", "preload", "rig", "arm", "joints", "transmission", "elastic",
                   "covariance"});
  Model model;
  model.rig = read_rig_reference(root.find("rig"));
  model.preload = text_or(root, "preload", model.rig.preload);
  if (const JsonNode* arm = root.find("arm")) model.arm = read_arm(*arm, model.rig);
  read_joints(root.at("joints"), &model);
  require_one_inertia(model, root);
  if (model.rigid) {
    if (const JsonNode* node = root.find("transmission")) {
      throw node->error("a rigid drive has no transmission", "drop it, or give link and motor");
    }
  } else {
    read_transmission(root.at("transmission"), &model);
  }
  if (const JsonNode* others = root.find("elastic")) read_other_results(*others, &model);
  if (const JsonNode* node = root.find("covariance")) model.covariance = read_covariance(*node);
  if (wanted.completeness == Completeness::can_move) require_inertia(model, root.at("joints"));
  model.name = text_or(root, "name", default_model_name(model));
  require_wanted(root, "model", model.name, wanted.model);
  require_wanted(root, "preload", model.preload, wanted.preload);
  *choice = fmt::format("model '{}' of {}", model.name, root.place.file);
  return model;
}

}  // namespace cablefit::model_file
