#include "cablefit/model/least_inertias.hpp"

#include <algorithm>

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

LeastInertias least_inertias(const Model& model, bool link_blocked) {
  LeastInertias least;
  const std::vector<double> links = link_inertias(model);
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double motor = inertia_of(model.joints[k].motor);
    least.motor = std::min(least.motor, motor);
    least.all = std::min(least.all, motor + (link_blocked ? 0 : links[k]));
  }
  return least;
}

}  // namespace cablefit
