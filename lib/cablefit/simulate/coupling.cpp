#include "cablefit/simulate/coupling.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

auto as_they_are(const double* q) {
  return [q](std::size_t k) { return q[k]; };
}

void append_radii(std::vector<double>& all, const std::vector<DisplacementMap>& more) {
  for (const DisplacementMap& map : more) all.push_back(map.radius(0));
}

}  // namespace

Coupling::Coupling(const Transmission& transmission)
    : n_joints_(static_cast<std::size_t>(transmission.n_joints)) {
  const Eigen::VectorXd theta_0 = transmission.encoder_zero();
  theta_0_.assign(theta_0.begin(), theta_0.end());
  for (const Cable& cable : transmission.cables) {
    const bool round = cable.motor_side().is_round() && cable.link_side().is_round();
    Strand strand{.basis = cable.law->basis,
                  .slope = cable.law->slope,
                  .shape = cable.shape(),
                  .n_coefficients = cable.n_coefficients(),
                  .slack = cable.shift(),
                  .first_joint = motor_radius_.size(),
                  .maps = maps_.size(),
                  .round = round};
    std::copy(cable.coefficients.begin(), cable.coefficients.end(), strand.coefficients.begin());
    if (round) strand.slack -= cable.motor_radii(theta_0).dot(theta_0);
    cables_.push_back(strand);
    maps_.push_back(cable);
    append_radii(motor_radius_, cable.motor_map);
    append_radii(link_radius_, cable.link_map);
  }
  if (!cables_.empty()) return;
  const Eigen::VectorXd& stiffness = transmission.linear_stiffness;
  stiffness_.assign(stiffness.begin(), stiffness.end());
  const Eigen::VectorXd reduction = transmission.reductions();
  reduction_.assign(reduction.begin(), reduction.end());
  const Eigen::VectorXd rest =
      theta_0 + transmission.reference_theta() - reduction.cwiseProduct(transmission.reference_q());
  rest_.assign(rest.begin(), rest.end());
}

double Coupling::elongation(const Strand& strand, const double* q, const double* theta) const {
  const Cable& cable = maps_[strand.maps];
  return strand.slack + cable.motor_side().displacement(turned(theta)) -
         cable.link_side().displacement(as_they_are(q));
}

void Coupling::look(std::size_t joint, const double* q, const double* theta, const Pull* cables,
                    JointState& state) const {
  const auto angle = turned(theta);
  state.deflection = angle(joint) - q[joint];
  if (cables_.empty()) {
    state.deflection = deflection(joint, q, theta);
    state.stiffness = stiffness_[joint];
    state.tension = std::abs(state.stiffness * state.deflection);
    return;
  }
  state.stiffness = state.tension = 0;
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    const Strand& strand = cables_[i];
    const SideMaps motor = maps_[strand.maps].motor_side();
    const double radius =
        strand.round ? motor_radius_[strand.first_joint + joint] : motor.radius(joint, angle);
    if (strand.round && radius == 0) continue;  // another joint's cable
    const auto& [elongation, tension] = cables[i];
    state.stiffness += radius * radius * combine(strand, strand.slope, elongation);
    if (!strand.round) state.stiffness += motor.radius_slope(joint, angle) * tension;
    state.tension += std::abs(radius) * tension;
  }
}

void Coupling::add_by_maps(const Strand& strand, double force, const double* q, const double* theta,
                           double* link, double* motor) const {
  const SideMaps motors = maps_[strand.maps].motor_side(), links = maps_[strand.maps].link_side();
  for (std::size_t k = 0; k < n_joints_; ++k) {
    link[k] += force * links.radius(k, as_they_are(q));
    motor[k] += force * motors.radius(k, turned(theta));
  }
}

}  // namespace cablefit
