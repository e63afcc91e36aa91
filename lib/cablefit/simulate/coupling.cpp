#include "cablefit/simulate/coupling.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

bool all_round(const std::vector<DisplacementMap>& maps) {
  return std::all_of(maps.begin(), maps.end(),
                     [](const DisplacementMap& map) { return map.kind->constant_radius; });
}

void append(std::vector<DisplacementMap>& all, const std::vector<DisplacementMap>& more) {
  all.insert(all.end(), more.begin(), more.end());
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
    const bool round = all_round(cable.motor_map) && all_round(cable.link_map);
    Strand strand{cable.law->basis, cable.law->slope,  cable.shape(), cable.n_coefficients(), {},
                  cable.shift(),    motor_map_.size(), round};
    std::copy(cable.coefficients.begin(), cable.coefficients.end(), strand.coefficients.begin());
    if (round) strand.slack -= cable.motor_radii(theta_0).dot(theta_0);
    cables_.push_back(strand);
    append(motor_map_, cable.motor_map);
    append(link_map_, cable.link_map);
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
  double l = strand.slack;
  for (std::size_t k = 0; k < n_joints_; ++k) {
    l += motor_map_[strand.first_joint + k].displacement(theta[k] - theta_0_[k]) -
         link_map_[strand.first_joint + k].displacement(q[k]);
  }
  return l;
}

void Coupling::look(std::size_t joint, const double* q, const double* theta,
                    JointState& state) const {
  const double turned = theta[joint] - theta_0_[joint];
  state.deflection = turned - q[joint];
  if (cables_.empty()) {
    state.deflection = deflection(joint, q, theta);
    state.stiffness = stiffness_[joint];
    state.tension = std::abs(state.stiffness * state.deflection);
    return;
  }
  state.stiffness = state.tension = 0;
  for (const Strand& strand : cables_) {
    const std::size_t place = strand.first_joint + joint;
    const double radius = strand.round ? motor_radius_[place] : motor_map_[place].radius(turned);
    if (strand.round && radius == 0) continue;  // another joint's cable
    const double l = stretch(strand, q, theta);
    const double force = combine(strand, strand.basis, l);
    state.stiffness += radius * radius * combine(strand, strand.slope, l);
    if (!strand.round) state.stiffness += motor_map_[place].radius_slope(turned) * force;
    state.tension += std::abs(radius) * force;
  }
}

void Coupling::add_by_maps(const Strand& strand, double force, const double* q, const double* theta,
                           double* link, double* motor) const {
  for (std::size_t k = 0; k < n_joints_; ++k) {
    link[k] += force * link_map_[strand.first_joint + k].radius(q[k]);
    motor[k] += force * motor_map_[strand.first_joint + k].radius(theta[k] - theta_0_[k]);
  }
}

}  // namespace cablefit
