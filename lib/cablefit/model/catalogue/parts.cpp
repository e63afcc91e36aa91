#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

namespace cablefit {

void set_elastic(const Transmission& transmission, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& theta, int joint, JointState& state) {
  const Eigen::VectorXd turned = theta - transmission.encoder_zero();
  state.deflection = turned[joint] - q[joint];
  if (transmission.cables.empty()) {
    state.deflection =
        transmission.deflections(joint, q.segment<1>(joint), theta.segment<1>(joint))(0);
    state.stiffness = transmission.linear_stiffness[joint];
    state.tau_elas = state.stiffness * state.deflection;
    state.tension = std::abs(state.tau_elas);
    return;
  }
  state.tau_elas = state.stiffness = state.tension = 0;
  const auto own = static_cast<std::size_t>(joint);
  const auto angle = [&](std::size_t k) { return turned[static_cast<Eigen::Index>(k)]; };
  for (const Cable& cable : transmission.cables) {
    const SideMaps motor = cable.motor_side();
    const double l = cable.elongation(q, turned);
    const double force = cable.force(l), radius = motor.radius(own, angle);
    state.tau_elas += radius * force;
    state.stiffness +=
        radius * radius * cable.stiffness(l) + motor.radius_slope(own, angle) * force;
    state.tension += std::abs(radius) * force;
  }
}

namespace rows {

double slid(double z, double way, double distance) {
  if (way == 0) return z;
  const double end = way > 0 ? 1 : -1;
  return end + (z - end) * std::exp(-std::abs(way) / distance);
}

double settled(double t, double T) { return t > 0 ? -std::expm1(-t / T) : 0; }

void two_harmonics(double x, double* values) {
  const double s = std::sin(x), c = std::cos(x);
  values[0] = s;
  values[1] = c;
  values[2] = 2 * s * c;
  values[3] = c * c - s * s;
}

}  // namespace rows
}  // namespace cablefit
