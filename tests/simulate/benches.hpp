// Models and inputs for the simulator's tests.
#pragma once

#include <string>
#include <vector>

#include "cablefit/simulate/simulator.hpp"

namespace cablefit::test {

/// The base effects of a side with these values, in the order of the table.
inline std::vector<EffectInstance> base_effects_with(Side side, const std::vector<double>& values) {
  std::vector<EffectInstance> result;
  std::size_t next = 0;
  for (const Effect& effect : base_effects(side)) {
    EffectInstance& instance = result.emplace_back();
    instance.effect = &effect;
    for (const ParameterInfo& info : effect.parameters) {
      Estimate& estimate = instance.parameters.emplace_back();
      estimate.name = info.name;
      estimate.value = values.at(next++);
    }
  }
  return result;
}

/// One joint: {J_link, f_v, f_s}, {J_motor, f_vm, f_sm, offset} and a linear spring K (N m/rad).
inline Model spring_joint(const std::vector<double>& link, const std::vector<double>& motor,
                          double stiffness) {
  Model model;
  model.rig = default_rig();
  model.joints.push_back(
      {base_effects_with(Side::link, link), base_effects_with(Side::motor, motor)});
  model.transmission.theta_0 = Eigen::VectorXd::Zero(1);
  model.transmission.linear_stiffness = Eigen::VectorXd::Constant(1, stiffness);
  return model;
}

/// A drive without elasticity: {J, f_v, f_s, offset}.
inline Model rigid_drive(const std::vector<double>& values) {
  Model model;
  model.rigid = true;
  model.rig = default_rig();
  model.joints.push_back({{}, base_effects_with(Side::rigid, values)});
  return model;
}

/// The paper's rig, low preload: Table 1 (polynomial) and Table 2 ("low, poly").
inline Model paper_rig_low() {
  Model model = spring_joint({0.339, 5.601, 3.274}, {0.0133, 1.0654, 2.778, 0.0286}, 0);
  model.transmission = antagonist_pair(2);
  model.transmission.cables[0].coefficients = {1367.7, 37844.1};
  model.transmission.cables[1].coefficients = {1575.3, 29357.2};
  return model;
}

/// `rows` rows of `period` (s) without any torque, from rest at 0.
inline SimulationInput quiet_input(Eigen::Index rows, double period, Eigen::Index n_joints = 1) {
  SimulationInput input;
  input.period = period;
  input.tau = Eigen::ArrayXXd::Zero(rows, n_joints);
  input.q0 = input.qd0 = input.theta0 = input.thetad0 = Eigen::VectorXd::Zero(n_joints);
  return input;
}

inline SimulationOptions step_of(double step) {
  SimulationOptions options;
  options.step = step;
  return options;
}

/// Order of convergence from the errors at h, h/2 and h/4: slope of their logarithms over the two
/// halvings.
inline double convergence_order(const std::vector<double>& errors) {
  return std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
}

}  // namespace cablefit::test
