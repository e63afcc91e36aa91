#include "cablefit/model/joint_inertias.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "cablefit/model/arm/arm_dynamics.hpp"

namespace cablefit {

std::vector<double> link_inertias(const Model& model) {
  const std::size_t n = model.joints.size();
  std::vector<double> inertias;
  if (!model.is_coupled()) {
    for (const JointModel& joint : model.joints) inertias.push_back(inertia_of(joint.link));
    return inertias;
  }
  const std::vector<double> zero(n, 0.0);
  ArmDynamics arm = arm_dynamics(model.rig.arm, model.arm);
  arm.evaluate(zero.data(), zero.data());
  for (std::size_t k = 0; k < n; ++k) inertias.push_back(arm.mass()[k * (n + 1)]);
  return inertias;
}

std::vector<JointInertias> joint_inertias(const Model& model, bool link_blocked) {
  const std::vector<double> links = link_inertias(model);
  std::vector<JointInertias> inertias;
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double motor = inertia_of(model.joints[k].motor);
    inertias.push_back({motor, motor + (link_blocked ? 0 : std::max(0.0, links[k]))});
  }
  return inertias;
}

Controller pd_controller(const JointInertias& inertias, double bandwidth, double damping,
                         double period) {
  constexpr double kLargestGain = 0.3;  // kd period / J_motor; a sampled loop is unstable at 2
  const double omega = 2 * std::numbers::pi * bandwidth;
  Controller controller;
  controller.kd =
      std::min(2 * damping * inertias.all * omega, kLargestGain * inertias.motor / period);
  controller.kp = controller.kd * omega / (2 * damping);
  controller.period = period;
  return controller;
}

Controller controller_by_inertias(const Model& model, bool link_blocked,
                                  const std::function<Controller(const JointInertias&)>& law) {
  std::vector<Controller> controllers;
  for (const JointInertias& inertias : joint_inertias(model, link_blocked))
    controllers.push_back(law(inertias));
  return controller_of(std::move(controllers));
}

}  // namespace cablefit
