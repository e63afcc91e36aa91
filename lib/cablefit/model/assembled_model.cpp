#include "cablefit/model/assembled_model.hpp"

#include <utility>

namespace cablefit {
namespace {

Estimate blank(std::string name, std::string_view symbol, std::string unit) {
  Estimate e;
  e.name = std::move(name);
  e.symbol = symbol;
  e.unit = std::move(unit);
  return e;
}

std::vector<Estimate> arm_of(const Rig& rig, const FindEstimate& find) {
  std::vector<Estimate> arm;
  for (const ParameterInfo& info : rig.arm.base_parameters()) {
    auto e = find(blank(std::string(info.name), info.symbol, std::string(info.unit)));
    if (!e) return {};
    arm.push_back(*std::move(e));
  }
  return arm;
}

}  // namespace

Model assembled_model(const Rig& rig, bool rigid, const FindEstimate& find) {
  Model model;
  model.rig = rig;
  model.rigid = rigid;
  model.arm = arm_of(rig, find);
  for (int joint = 1; joint <= rig.n_joints(); ++joint) {
    JointModel& axes = model.joints.emplace_back();
    if (!rigid) axes.link = base_instances(Side::link, joint, rig, find);
    axes.motor = base_instances(rigid ? Side::rigid : Side::motor, joint, rig, find);
  }
  return model;
}

std::vector<Estimate> elastic_estimates(const Transmission& transmission, const Rig& rig,
                                        const FindEstimate& find) {
  std::vector<Estimate> found;
  const auto add = [&](const std::string& name, const std::string& unit) {
    if (auto e = find(blank(name, name, unit))) found.push_back(*std::move(e));
  };
  const bool cable_space = rig.cables_given;
  const auto unit_of = [&](const Cable& cable, std::string_view unit) {
    return cable_space ? std::string(unit) : unit_for(axes_of(rig.axes, cable), unit);
  };
  if (transmission.cables.empty())
    for (int joint = 1; joint <= rig.n_joints(); ++joint)
      add(joint_parameter_name("K", joint, rig.n_joints()),
          unit_for(rig.axes.of(joint - 1), "N m/rad"));
  for (const Cable& cable : transmission.cables)
    for (int k = 0; k < cable.n_coefficients(); ++k)
      add(coefficient_name(cable, k, cable_space),
          unit_of(cable, coefficient_unit(*cable.law, k, cable_space)));
  for (const Cable& cable : transmission.cables)
    add(elongation_name(cable), unit_of(cable, elongation_unit(cable_space)));
  return found;
}

}  // namespace cablefit
