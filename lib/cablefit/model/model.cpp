#include "cablefit/model/model.hpp"

#include <fmt/core.h>

#include <utility>

namespace cablefit {

Model::Model() = default;
Model::Model(const Model&) = default;
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(const Model&) = default;
Model& Model::operator=(Model&&) noexcept = default;
Model::~Model() = default;

std::string joint_parameter_name(std::string_view name, int joint, int n_joints) {
  return n_joints > 1 ? fmt::format("{}[{}]", name, joint) : std::string(name);
}

Estimate blank_estimate(const ParameterInfo& parameter, int joint, const Rig& rig) {
  Estimate estimate;
  estimate.name = joint_parameter_name(parameter.name, joint, rig.n_joints());
  estimate.symbol = parameter.symbol;
  estimate.unit = unit_for(rig.axes.of(joint - 1), parameter.unit);
  return estimate;
}

std::vector<EffectInstance> base_instances(Side side, int joint, const Rig& rig,
                                           const FindEstimate& find) {
  std::vector<EffectInstance> instances;
  for (const Effect& effect : base_effects(side))
    if (std::optional<Estimate> e = find(blank_estimate(effect.parameters.front(), joint, rig)))
      instances.push_back({&effect, {std::move(*e)}});
  return instances;
}

std::string_view default_model_name(const Model& model) {
  if (model.rigid) return "rigid";
  return model.transmission.cables.empty() ? "linear" : "poly";
}

}  // namespace cablefit
