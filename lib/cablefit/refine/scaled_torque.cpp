#include "cablefit/refine/scaled_torque.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace cablefit {
namespace {

void multiply(Estimate& e, double by, double relative_sd) {
  const double sd = by * std::hypot(e.sd, relative_sd * e.value);
  const double wider = e.sd > 0 ? sd / e.sd : by;
  e.ci_low = by * e.value + wider * (e.ci_low - e.value);
  e.ci_high = by * e.value + wider * (e.ci_high - e.value);
  e.value *= by;
  e.sd = sd;
  e.sd_white *= by;
}

/// Scales a model's estimates, and remembers by how much for their covariance.
class Scaling {
 public:
  explicit Scaling(const TorqueFactor& factor) : factor_(factor) {}

  void scale(Estimate& e) {
    const Moved moved{factor_.of(e.unit), e.value};
    factor_.scale(e);
    moved_[e.name] = moved;
    moved_[e.name.substr(0, e.name.rfind('['))] = moved;  // its name in the model of one joint
  }

  void scale(EffectInstance& instance) {
    if (!is_of_motor(*instance.effect)) {
      for (Estimate& e : instance.parameters) scale(e);
    } else if (instance.effect->level != nullptr) {  // a share of a tension, in the motor's torque
      for (std::size_t k = 0; k < instance.effect->n_linear(); ++k) {
        Estimate& e = instance.parameters[k];
        if (e.unit.empty()) multiply(e, 1 / factor_.value, factor_.relative_sd);
      }
    }
  }

  void scale(Transmission& transmission) const {
    for (Cable& cable : transmission.cables)
      for (double& coefficient : cable.coefficients) coefficient *= factor_.value;
    transmission.linear_stiffness *= factor_.value;
  }

  void scale(ParameterCovariance& covariance) const {
    const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
    Eigen::VectorXd by = Eigen::VectorXd::Ones(n), common = Eigen::VectorXd::Zero(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto found = moved_.find(covariance.parameters[static_cast<std::size_t>(k)]);
      if (found == moved_.end()) continue;
      by(k) = found->second.by;
      if (by(k) != 1) common(k) = factor_.relative_sd * by(k) * found->second.value;
    }
    if (n > 0)
      covariance.matrix =
          by.asDiagonal() * covariance.matrix * by.asDiagonal() + common * common.transpose();
  }

 private:
  struct Moved {
    double by = 1, value = 0;
  };
  TorqueFactor factor_;
  std::map<std::string, Moved> moved_;
};

/// A coefficient of a cable or K; other results of stage 1 are the motors'.
bool is_stiffness(const Estimate& e) {
  return e.unit.find("N/m") != std::string::npos || e.unit.find("N m/rad") != std::string::npos;
}

}  // namespace

double TorqueFactor::of(const std::string& unit) const {
  if (unit.find("/(N") != std::string::npos) return 1 / value;  // a compliance
  const bool is_torque =
      unit.find('N') != std::string::npos || unit.find("kg") != std::string::npos;
  return is_torque ? value : 1;
}

void TorqueFactor::scale(Estimate& e) const {
  const double by = of(e.unit);
  if (by != 1) multiply(e, by, relative_sd);
}

Model with_link_torque(Model model, const TorqueFactor& factor) {
  Scaling scaling(factor);
  for (JointModel& joint : model.joints) {
    for (EffectInstance& instance : joint.link) scaling.scale(instance);
    for (EffectInstance& instance : joint.added) scaling.scale(instance);
  }
  for (Estimate& e : model.arm) scaling.scale(e);
  for (Estimate& e : model.elastic)
    if (is_stiffness(e)) scaling.scale(e);
  scaling.scale(model.transmission);
  scaling.scale(model.covariance);
  return model;
}

bool is_of_motor(const Effect& row) {
  return row.site == Site::motor || row.site == Site::drive || row.site == Site::rigid;
}

bool is_of_motor(const Model& one, const std::string& parameter) {
  const std::vector<EffectInstance>& motor = one.joints.front().motor;
  return std::any_of(motor.begin(), motor.end(), [&](const EffectInstance& instance) {
    return find_estimate(instance.parameters, parameter) != nullptr;
  });
}

}  // namespace cablefit
