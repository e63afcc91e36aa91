#include "cablefit/elastic/elastic_columns.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace cablefit {
namespace {

Eigen::ArrayXd deflection(const Transmission& transmission, const JointSignals& s) {
  const double zero = transmission.theta_0.size() > 0 ? transmission.theta_0(0) : 0.0;
  return s.theta - zero - s.q;
}

// -1 or 1: the friction branch. In motion the velocity tells it at once; at rest, and where motion
// does not stand out of the noise (rest_speed 0), the direction of the last motion does.
Eigen::ArrayXd branch(const JointSignals& s, double rest_speed) {
  if (!(rest_speed > 0)) return s.approach;
  return (s.thetad.abs() > rest_speed).select(s.thetad.sign(), s.approach);
}

// d tau_elas_m / d theta of a fitted transmission, one joint: S df/dl S + dS/dtheta f.
double motor_stiffness(const Transmission& transmission, double q, double theta) {
  if (transmission.cables.empty()) return transmission.linear_stiffness(0);
  const double turned = theta - (transmission.theta_0.size() > 0 ? transmission.theta_0(0) : 0.0);
  double sum = 0;
  for (const Cable& cable : transmission.cables) {
    const DisplacementMap& motor = cable.motor_map.front();
    const double l =
        motor.displacement(turned) - cable.link_map.front().displacement(q) + cable.shift();
    const double radius = motor.radius(turned);
    sum += radius * radius * cable.stiffness(l) + motor.radius_slope(turned) * cable.force(l);
  }
  return sum;
}

// Elongation of one cable of one joint, row by row.
Eigen::ArrayXd elongation(const Cable& cable, const Eigen::ArrayXd& q,
                          const Eigen::ArrayXd& turned) {
  return cable.motor_map.front().displacements(turned) - cable.link_map.front().displacements(q) +
         cable.shift();
}

}  // namespace

Eigen::Index n_elastic_columns(const Transmission& transmission) {
  Eigen::Index n = 0;
  for (const Cable& cable : transmission.cables) n += cable.law->n_coefficients(cable.order);
  return n;
}

void elastic_basis(const Transmission& transmission, const JointSignals& s, ElasticSide side,
                   Eigen::Ref<Eigen::MatrixXd> out) {
  const double zero = transmission.theta_0.size() > 0 ? transmission.theta_0(0) : 0.0;
  const Eigen::ArrayXd turned = s.theta - zero;
  std::array<double, kMaxCableOrder> values{};
  Eigen::Index first = 0;
  for (const Cable& cable : transmission.cables) {
    const int n = cable.n_coefficients();
    const LawShape shape = cable.shape();
    const Eigen::ArrayXd l = elongation(cable, s.q, turned);
    const Eigen::ArrayXd gain = side == ElasticSide::motor ? cable.motor_map.front().radii(turned)
                                                           : cable.link_map.front().radii(s.q);
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      if (l(i) > 0) {
        cable.law->basis(shape, l(i), values.data());
      } else {
        values.fill(0);
      }
      for (int k = 0; k < n; ++k) out(i, first + k) = gain(i) * values[static_cast<std::size_t>(k)];
    }
    first += n;
  }
}

BlockedColumns blocked_columns(const Transmission& transmission) {
  BlockedColumns c;
  c.n_basis = n_elastic_columns(transmission);
  c.offset = c.basis + c.n_basis;
  c.direction = c.offset + 1;
  c.speed = c.direction + 1;
  c.zero = c.speed + 1;
  c.tau = c.zero + 1;
  c.count = c.tau + 1;
  return c;
}

Equation blocked_equation(const Transmission& transmission, const Transmission* pilot, bool sliding,
                          double rest_speed, double still_speed) {
  const BlockedColumns c = blocked_columns(transmission);
  Equation equation;
  equation.name = "blocked";
  equation.columns.assign(static_cast<std::size_t>(c.count), "");
  equation.averaged.assign(static_cast<std::size_t>(c.count),
                           false);  // quasi-static: no difference
  const std::optional<Transmission> curve = pilot ? std::optional(*pilot) : std::nullopt;
  // The direction is decimated as the torque is: beside a reversal both pass through zero.
  equation.prepare = [rest_speed](Signals& signals) {
    JointSignals& s = signals.joints[0];
    s.theta_direction = branch(s, rest_speed);
  };
  equation.fill = [transmission, c, curve](const Signals& signals,
                                           Eigen::Ref<Eigen::MatrixXd> out) {
    const JointSignals& s = signals.joints[0];
    out.col(c.deflection) = deflection(transmission, s);
    elastic_basis(transmission, s, ElasticSide::motor, out.middleCols(c.basis, c.n_basis));
    out.col(c.offset).setOnes();
    out.col(c.direction) = s.theta_direction;
    out.col(c.speed) = s.thetad;
    if (!curve) {
      out.col(c.zero).setZero();
    } else {
      for (Eigen::Index i = 0; i < out.rows(); ++i)
        out(i, c.zero) = -motor_stiffness(*curve, s.q(i), s.theta(i));
    }
    out.col(c.tau) = s.tau;
  };
  const auto slow = [rest_speed](const JointSignals& s) {
    return (s.thetad.abs() < rest_speed).cast<double>().eval();
  };
  if (sliding) {
    equation.rest_speed = rest_speed;
    equation.speed = [](const Signals& signals) { return signals.joints[0].thetad; };
  }
  equation.use = [sliding, slow, still_speed](const Signals& signals) -> Eigen::ArrayXd {
    const JointSignals& s = signals.joints[0];
    Eigen::ArrayXd use = (s.approach != 0.0).cast<double>();  // before the first motion: no branch
    if (!sliding) use *= slow(s);  // no row is slower than 0: then all count as sliding
    if (still_speed > 0) use *= (s.qd.abs() < still_speed).cast<double>();
    return use;
  };
  return equation;
}

}  // namespace cablefit
