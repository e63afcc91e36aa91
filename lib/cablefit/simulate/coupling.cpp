#include "cablefit/simulate/coupling.hpp"

#include <algorithm>

namespace cablefit {

Coupling::Coupling(const Transmission& transmission)
    : n_joints_(static_cast<std::size_t>(transmission.n_joints)) {
  const Eigen::VectorXd theta_0 = transmission.encoder_zero();
  const Eigen::VectorXd& stiffness = transmission.linear_stiffness;
  for (const Cable& cable : transmission.cables) {
    Strand strand{cable.law->basis,    cable.order, cable.n_coefficients(), {}, 0,
                  motor_radius_.size()};
    std::copy(cable.coefficients.begin(), cable.coefficients.end(), strand.coefficients.begin());
    strand.slack = cable.initial_elongation - cable.motor_radius.dot(theta_0);
    cables_.push_back(strand);
    motor_radius_.insert(motor_radius_.end(), cable.motor_radius.begin(), cable.motor_radius.end());
    link_radius_.insert(link_radius_.end(), cable.link_radius.begin(), cable.link_radius.end());
  }
  if (!cables_.empty()) return;
  stiffness_.assign(stiffness.begin(), stiffness.end());
  theta_0_.assign(theta_0.begin(), theta_0.end());
}

}  // namespace cablefit
