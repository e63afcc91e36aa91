#include "cablefit/refine/scaled_torque.hpp"

#include <algorithm>
#include <map>

namespace cablefit {
namespace {

/// Scales estimates, and remembers by how much for their covariance.
class Scaling {
 public:
  explicit Scaling(double factor) : factor_(factor) {}

  void scale(Estimate& e) {
    const double by = torque_power(e.unit, factor_);
    for (double Estimate::*number : {&Estimate::value, &Estimate::sd, &Estimate::sd_white,
                                     &Estimate::ci_low, &Estimate::ci_high})
      e.*number *= by;
    by_[e.name] = by;
  }
  void scale(std::vector<EffectInstance>& effects) {
    for (EffectInstance& instance : effects)
      for (Estimate& e : instance.parameters) scale(e);
  }
  void scale(Transmission& transmission) const {
    for (Cable& cable : transmission.cables)
      for (double& coefficient : cable.coefficients) coefficient *= factor_;
    transmission.linear_stiffness *= factor_;
  }
  void scale(ParameterCovariance& covariance) const {
    for (std::size_t k = 0; k < covariance.parameters.size(); ++k) {
      const auto found = by_.find(covariance.parameters[k]);
      if (found == by_.end()) continue;
      const auto at = static_cast<Eigen::Index>(k);
      covariance.matrix.row(at) *= found->second;
      covariance.matrix.col(at) *= found->second;
    }
  }

 private:
  double factor_;
  std::map<std::string, double> by_;
};

bool is_of_motor(const Effect& row) {
  return row.site == Site::motor || row.site == Site::drive || row.site == Site::rigid;
}

}  // namespace

double torque_power(const std::string& unit, double factor) {
  if (unit.find("/(N") != std::string::npos) return 1 / factor;  // a compliance
  const bool is_torque =
      unit.find('N') != std::string::npos || unit.find("kg") != std::string::npos;
  return is_torque ? factor : 1;
}

Model with_torque_times(Model model, double factor) {
  Scaling scaling(factor);
  for (JointModel& joint : model.joints)
    for (auto* effects : {&joint.link, &joint.motor, &joint.added}) scaling.scale(*effects);
  for (Estimate& e : model.arm) scaling.scale(e);
  for (Estimate& e : model.elastic) scaling.scale(e);
  scaling.scale(model.transmission);
  scaling.scale(model.covariance);
  return model;
}

Model with_link_torque_times(Model one, double factor) {
  Scaling scaling(factor);
  JointModel& joint = one.joints.front();
  scaling.scale(joint.link);
  for (EffectInstance& instance : joint.added)
    if (!is_of_motor(*instance.effect))
      for (Estimate& e : instance.parameters) scaling.scale(e);
  for (Estimate& e : one.arm) scaling.scale(e);
  for (Estimate& e : one.elastic)
    if (!is_of_motor(one, e.name)) scaling.scale(e);
  scaling.scale(one.transmission);
  scaling.scale(one.covariance);
  return one;
}

bool is_of_motor(const Model& one, const std::string& parameter) {
  const std::vector<EffectInstance>& motor = one.joints.front().motor;
  return std::any_of(motor.begin(), motor.end(), [&](const EffectInstance& instance) {
    return find_estimate(instance.parameters, parameter) != nullptr;
  });
}

}  // namespace cablefit
