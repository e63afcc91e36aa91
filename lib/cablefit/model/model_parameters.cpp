#include "cablefit/model/model_parameters.hpp"

#include <algorithm>

#include "cablefit/model/effects/effects_per_joint.hpp"

namespace cablefit {
namespace {

void add_arm(const Model& model, std::vector<ModelParameter>& out) {
  const std::vector<ParameterInfo> infos = model.rig.arm.base_parameters();
  for (std::size_t k = 0; k < model.arm.size(); ++k) {
    ModelParameter p;
    p.kind = ParameterKind::arm;
    p.name = infos[k].name;
    p.symbol = infos[k].symbol;
    p.unit = infos[k].unit;
    p.lower = infos[k].lower;
    p.upper = infos[k].upper;
    p.index = k;
    out.push_back(p);
  }
}

void add_effects(const Model& model, int joint, bool on_link, std::vector<ModelParameter>& out) {
  const JointModel& axes = model.joints[static_cast<std::size_t>(joint)];
  const std::vector<EffectInstance>& instances = on_link ? axes.link : axes.motor;
  for (std::size_t e = 0; e < instances.size(); ++e) {
    const ParameterInfo& info = instances[e].effect->parameters.front();
    const Estimate blank = blank_estimate(info, joint + 1, model.rig);
    ModelParameter p;
    p.name = blank.name;
    p.symbol = blank.symbol;
    p.unit = blank.unit;
    p.lower = info.lower;
    p.upper = info.upper;
    p.joint = joint;
    p.on_link = on_link;
    p.effect = e;
    out.push_back(p);
  }
}

/// What came from other logs may lie outside, and goes no further out.
void keep_in_range(const ShapeGrid& grid, double value, ModelParameter& p) {
  if (grid.unit != GridUnit::si) return;
  p.lower = std::min(std::max(p.lower, grid.low), value);
  p.upper = std::max(std::min(p.upper, grid.high), value);
}

void add_added(const Model& model, int joint, std::vector<ModelParameter>& out) {
  const std::vector<EffectInstance>& added = model.joints[static_cast<std::size_t>(joint)].added;
  for (std::size_t e = 0; e < added.size(); ++e)
    for (std::size_t k = 0; k < added[e].parameters.size(); ++k) {
      const ParameterInfo& info = added[e].effect->parameters[k];
      const std::size_t n_linear = added[e].effect->n_linear();
      ModelParameter p;
      p.kind = ParameterKind::added;
      p.name = added_parameter_name(*added[e].effect, info, joint,
                                    static_cast<int>(model.joints.size()));
      p.symbol = info.symbol;
      p.unit = unit_for(model.rig.axes.of(joint), info.unit);
      p.lower = info.lower;
      p.upper = info.upper;
      p.joint = joint;
      p.effect = e;
      p.index = k;
      if (k >= n_linear)
        keep_in_range(added[e].effect->shape[k - n_linear], added[e].parameters[k].value, p);
      out.push_back(p);
    }
}

ModelParameter per_joint(ParameterKind kind, std::string_view name, std::string_view unit,
                         int joint, const Model& model) {
  ModelParameter p;
  p.kind = kind;
  p.name = joint_parameter_name(name, joint + 1, static_cast<int>(model.joints.size()));
  p.symbol = p.name;
  p.unit = unit_for(model.rig.axes.of(joint), unit);
  p.joint = joint;
  return p;
}

void add_elastic(const Model& model, std::vector<ModelParameter>& out) {
  const auto n_joints = static_cast<int>(model.joints.size());
  const std::vector<Cable>& cables = model.transmission.cables;
  for (int joint = 0; cables.empty() && joint < n_joints; ++joint) {
    out.push_back(per_joint(ParameterKind::stiffness, "K", "N m/rad", joint, model));
    out.back().lower = 0;
  }
  const bool cable_space = model.rig.cables_given;
  for (std::size_t i = 0; i < cables.size(); ++i) {
    for (int j = 0; j < cables[i].n_coefficients(); ++j) {
      ModelParameter p;
      p.kind = ParameterKind::coefficient;
      p.name = p.symbol = coefficient_name(cables[i], j, cable_space);
      p.unit = unit_for(axes_of(model.rig.axes, cables[i]),
                        coefficient_unit(*cables[i].law, j, cable_space));
      p.cable = i;
      p.index = static_cast<std::size_t>(j);
      out.push_back(p);
    }
  }
  for (std::size_t i = 0; i < cables.size(); ++i) {
    ModelParameter p;
    p.kind = ParameterKind::elongation;
    p.name = p.symbol = elongation_name(cables[i]);
    p.unit = unit_for(axes_of(model.rig.axes, cables[i]), elongation_unit(cable_space));
    p.cable = i;
    out.push_back(p);
  }
  for (int joint = 0; joint < n_joints; ++joint)
    out.push_back(per_joint(ParameterKind::encoder_zero, "theta_0", "rad", joint, model));
}

/// The number itself, of a model that may be const. theta_0 must be there.
template <typename SomeModel>
auto& number(SomeModel& model, const ModelParameter& p) {
  auto& transmission = model.transmission;
  switch (p.kind) {
    case ParameterKind::arm:
      return model.arm[p.index].value;
    case ParameterKind::effect: {
      auto& axes = model.joints[static_cast<std::size_t>(p.joint)];
      return (p.on_link ? axes.link : axes.motor)[p.effect].parameters[p.index].value;
    }
    case ParameterKind::added:
      return model.joints[static_cast<std::size_t>(p.joint)]
          .added[p.effect]
          .parameters[p.index]
          .value;
    case ParameterKind::stiffness:
      return transmission.linear_stiffness[p.joint];
    case ParameterKind::coefficient:
      return transmission.cables[p.cable].coefficients[p.index];
    case ParameterKind::elongation:
      return transmission.cables[p.cable].initial_elongation;
    case ParameterKind::encoder_zero:
      break;
  }
  return transmission.theta_0[p.joint];
}

}  // namespace

std::vector<ModelParameter> model_parameters(const Model& model) {
  std::vector<ModelParameter> out;
  add_arm(model, out);
  for (int joint = 0; joint < static_cast<int>(model.joints.size()); ++joint) {
    if (!model.rigid) add_effects(model, joint, true, out);
    add_effects(model, joint, false, out);
    add_added(model, joint, out);
  }
  if (!model.rigid) add_elastic(model, out);
  return out;
}

bool is_inertia(const Model& model, const ModelParameter& p) {
  if (p.kind != ParameterKind::effect) return false;
  const JointModel& joint = model.joints[static_cast<std::size_t>(p.joint)];
  return (p.on_link ? joint.link : joint.motor)[p.effect].effect->is_inertia();
}

std::optional<std::size_t> shape_of(const Model& model, const ModelParameter& p) {
  if (p.kind != ParameterKind::added) return {};
  const JointModel& joint = model.joints[static_cast<std::size_t>(p.joint)];
  const std::size_t n_linear = joint.added[p.effect].effect->n_linear();
  if (p.index < n_linear) return {};
  return p.index - n_linear;
}

double parameter_value(const Model& model, const ModelParameter& parameter) {
  if (parameter.kind == ParameterKind::encoder_zero && model.transmission.theta_0.size() == 0)
    return 0;
  return number(model, parameter);
}

void set_parameter_value(Model& model, const ModelParameter& parameter, double value) {
  if (model.transmission.theta_0.size() == 0)
    model.transmission.theta_0 =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.joints.size()));
  number(model, parameter) = value;
}

}  // namespace cablefit
