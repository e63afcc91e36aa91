// Models of coupled arms with the numbers of plain rigs, and their inputs.
#pragma once

#include "cablefit/simulate/simulator.hpp"
#include "tests/simulate/benches.hpp"
#include "tests/support/plain_arm.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {

/// "serial" in numbers, so that no XML is read; `joints` from the base to the tip.
inline std::string serial_text(const PlainArm& arm) {
  std::string origins, rpy, axes, inertias;
  const auto add = [](std::string& list, const auto& numbers) {
    list += fmt::format("{}[{}]", list.empty() ? "" : ", ", fmt::join(numbers, ", "));
  };
  for (const PlainLink& link : arm.links) {
    const Eigen::Vector3d c = link.centre;
    const Eigen::Matrix3d about_axis =
        link.inertia +
        link.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
    const Eigen::Vector3d moment = link.mass * c;
    add(origins, link.origin);
    add(rpy, link.rpy);
    add(axes, link.axis);
    add(inertias, std::vector<double>{link.mass, moment(0), moment(1), moment(2), about_axis(0, 0),
                                      about_axis(0, 1), about_axis(0, 2), about_axis(1, 1),
                                      about_axis(1, 2), about_axis(2, 2)});
  }
  return fmt::format(
      R"( "arm": {{"type": "serial", "origins": [{}], "rpy": [{}], "axes": [{}], "inertias": [{}],
          "gravity": [{}]}},)",
      origins, rpy, axes, inertias, fmt::join(arm.gravity, ", "));
}

/// `more`: further keys of the rig, each with a comma behind.
inline Model arm_model(const PlainRig& plain, const PlainArm& arm, const std::string& more = "") {
  const TempFolder folder;
  Model model;
  model.rig = read_rig(folder.write("rig.json", rig_text(plain, serial_text(arm) + more)));
  const std::vector<double> values = model.rig.arm.described();
  const std::vector<ParameterInfo> infos = model.rig.arm.base_parameters();
  for (std::size_t k = 0; k < infos.size(); ++k) {
    Estimate& e = model.arm.emplace_back();
    e.name = infos[k].name;
    e.unit = infos[k].unit;
    e.value = values.at(k);
  }
  for (const PlainJoint& joint : plain.joints) {
    JointModel& axes = model.joints.emplace_back();
    axes.link = base_effects_with(Side::link, {0, joint.f_v, joint.f_s});
    axes.link.erase(axes.link.begin());  // the arm has the inertias
    axes.motor =
        base_effects_with(Side::motor, {joint.J_motor, joint.f_vm, joint.f_sm, joint.offset});
  }
  model.transmission = model.rig.transmission;
  for (std::size_t i = 0; i < plain.cables.size(); ++i)
    model.transmission.cables[i].coefficients = plain.cables[i].k;
  return model;
}

/// "controller" of a rig file.
inline std::string pd_text(double kp, double kd) {
  return fmt::format(R"( "controller": {{"type": "pd", "kp": {}, "kd": {}}},)", kp, kd);
}

/// Several tones per joint from rest, rad.
inline Eigen::ArrayXXd swinging(Eigen::Index rows, double period, Eigen::Index n_joints,
                                double size) {
  return Eigen::ArrayXXd::NullaryExpr(rows, n_joints, [&](Eigen::Index i, Eigen::Index j) {
    const double t = period * static_cast<double>(i), shift = 0.7 * static_cast<double>(j);
    const double fade = std::min(1.0, t);
    return fade * size *
           (0.6 * std::sin(2 * M_PI * (0.41 + 0.1 * shift) * t) +
            0.4 * std::sin(2 * M_PI * (1.3 + 0.2 * shift) * t + shift));
  });
}

}  // namespace cablefit::test
