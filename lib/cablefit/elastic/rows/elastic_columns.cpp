#include "cablefit/elastic/rows/elastic_columns.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <optional>

#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

double encoder_zero(const Transmission& transmission, std::size_t joint) {
  return transmission.theta_0.size() > 0 ? transmission.theta_0(static_cast<Eigen::Index>(joint))
                                         : 0.0;
}

// -1 or 1: the friction branch. In motion the velocity determines it at once. At rest, and where
// motion does not exceed the noise (rest_speed 0), the direction of the last motion does.
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

// Angles of row i, less the encoder zero on the motors.
auto angles_at(const Transmission& transmission, std::span<const JointSignals> joints, MapSide side,
               Eigen::Index i) {
  return [&transmission, joints, side, i](std::size_t k) {
    return side == MapSide::link ? joints[k].q(i)
                                 : joints[k].theta(i) - encoder_zero(transmission, k);
  };
}

// Adds what maps of two joints give to g - h.
void add_pairs(const Transmission& transmission, const Cable& cable,
               std::span<const JointSignals> joints, Eigen::ArrayXd& sum) {
  const auto add = [&](const std::vector<PairMap>& pairs, MapSide side, double sign) {
    for (const PairMap& pair : pairs)
      for (Eigen::Index i = 0; i < sum.size(); ++i) {
        const auto angle = angles_at(transmission, joints, side, i);
        sum(i) += sign * pair.at(angle(pair.joints[0]), angle(pair.joints[1])).displacement;
      }
  };
  add(cable.motor_pairs, MapSide::motor, 1);
  add(cable.link_pairs, MapSide::link, -1);
}

}  // namespace

Eigen::ArrayXd levers(const Transmission& transmission, const Cable& cable,
                      std::span<const JointSignals> joints, MapSide side, std::size_t own) {
  const bool on_motor = side == MapSide::motor;
  if (!cable.has_pairs()) {
    if (on_motor)
      return cable.motor_map[own].radii(joints[own].theta - encoder_zero(transmission, own));
    return cable.link_map[own].radii(joints[own].q);
  }
  const SideMaps maps = on_motor ? cable.motor_side() : cable.link_side();
  return Eigen::ArrayXd::NullaryExpr(joints[own].q.size(), [&](Eigen::Index i) {
    return maps.radius(own, angles_at(transmission, joints, side, i));
  });
}

Eigen::ArrayXd elongation(const Transmission& transmission, const Cable& cable,
                          std::span<const JointSignals> joints) {
  std::optional<Eigen::ArrayXd> sum;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (joints.size() > 1 && !cable.passes(k)) continue;
    const Eigen::ArrayXd turned = joints[k].theta - encoder_zero(transmission, k);
    Eigen::ArrayXd share =
        cable.motor_map[k].displacements(turned) - cable.link_map[k].displacements(joints[k].q);
    sum = sum ? Eigen::ArrayXd(*sum + share) : std::move(share);
  }
  if (sum && cable.has_pairs()) add_pairs(transmission, cable, joints, *sum);
  assert(sum && "a cable that no joint moves");
  return *sum + cable.shift();
}

Eigen::Index n_elastic_columns(const Transmission& transmission) {
  Eigen::Index n = 0;
  for (const Cable& cable : transmission.cables) n += cable.law->n_coefficients(cable.order);
  return n;
}

namespace {

// Column of S or P times the basis of one cable, row by row, at these elongations.
void fill_basis(const Cable& cable, const Eigen::ArrayXd& l, const Eigen::ArrayXd& gain,
                Eigen::Ref<Eigen::MatrixXd> out) {
  std::array<double, kMaxCableOrder> values{};
  const LawShape shape = cable.shape();
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    if (l(i) > 0) {
      cable.law->basis(shape, l(i), values.data());
    } else {
      values.fill(0);
    }
    for (Eigen::Index k = 0; k < out.cols(); ++k)
      out(i, k) = gain(i) * values[static_cast<std::size_t>(k)];
  }
}

void fill_all(const Transmission& transmission, std::span<const JointSignals> joints,
              ElasticSide side, std::size_t own, const Eigen::ArrayXXd& others,
              Eigen::Ref<Eigen::MatrixXd> out) {
  const MapSide lever_side = side == ElasticSide::motor ? MapSide::motor : MapSide::link;
  Eigen::Index first = 0, number = 0;
  for (const Cable& cable : transmission.cables) {
    const Eigen::Index n = cable.n_coefficients();
    const SideMaps maps = lever_side == MapSide::motor ? cable.motor_side() : cable.link_side();
    if (!maps.passes(own)) {
      out.middleCols(first, n).setZero();
    } else {
      Eigen::ArrayXd l = elongation(transmission, cable, joints);
      if (others.cols() > 0) l += others.col(number);
      fill_basis(cable, l, levers(transmission, cable, joints, lever_side, own),
                 out.middleCols(first, n));
    }
    first += n;
    ++number;
  }
}

}  // namespace

void elastic_basis(const Transmission& transmission, const JointSignals& signals, ElasticSide side,
                   Eigen::Ref<Eigen::MatrixXd> out, const Eigen::ArrayXXd& others) {
  fill_all(transmission, std::span(&signals, 1), side, 0, others, out);
}

void elastic_basis(const Transmission& transmission, std::span<const JointSignals> joints,
                   ElasticSide side, int joint, Eigen::Ref<Eigen::MatrixXd> out) {
  fill_all(transmission, joints, side, static_cast<std::size_t>(joint), {}, out);
}

BlockedColumns blocked_columns(const Transmission& transmission) {
  BlockedColumns c;
  const Eigen::Index n = c.n_joints = transmission.n_joints;
  c.basis = c.deflection + n;
  c.n_basis = n_elastic_columns(transmission);
  c.offset = c.basis + c.n_basis;
  c.direction = c.offset + n;
  c.speed = c.direction + n;
  c.zero = c.speed + n;
  c.tau = c.zero + n;
  c.elongation = c.tau + 1;
  c.count = c.elongation + static_cast<Eigen::Index>(transmission.cables.size());
  return c;
}

BlockedColumns BlockedColumns::of_joint(int joint) const {
  BlockedColumns own = *this;
  for (Eigen::Index BlockedColumns::*column :
       {&BlockedColumns::deflection, &BlockedColumns::offset, &BlockedColumns::direction,
        &BlockedColumns::speed, &BlockedColumns::zero})
    own.*column += joint;
  return own;
}

namespace {

// What the rows of one of several joints have in the others' columns.
void clear_others(const BlockedColumns& c, Eigen::Ref<Eigen::MatrixXd> out) {
  out.leftCols(c.basis).setZero();
  out.middleCols(c.basis + c.n_basis, c.tau - c.basis - c.n_basis).setZero();
}

void fill_elongations(const Transmission& transmission, const BlockedColumns& c,
                      std::span<const JointSignals> joints, Eigen::Ref<Eigen::MatrixXd> out) {
  for (std::size_t k = 0; k < transmission.cables.size(); ++k)
    out.col(c.elongation + static_cast<Eigen::Index>(k)) =
        elongation(transmission, transmission.cables[k], joints);
}

}  // namespace

namespace {

// d tau_elas_m of a joint / d theta_0 of every joint: minus the stiffness of the motors.
void fill_zeros(const Transmission& curve, std::span<const JointSignals> joints, int joint,
                Eigen::Ref<Eigen::MatrixXd> out) {
  if (joints.size() == 1) {
    for (Eigen::Index i = 0; i < out.rows(); ++i)
      out(i, 0) = -motor_stiffness(curve, joints[0].q(i), joints[0].theta(i));
    return;
  }
  const auto n = static_cast<Eigen::Index>(joints.size());
  Eigen::VectorXd q(n), theta(n);
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      q(k) = joints[static_cast<std::size_t>(k)].q(i);
      theta(k) = joints[static_cast<std::size_t>(k)].theta(i);
    }
    out.row(i) = -stiffness_matrices(curve, q, theta).motor_theta.row(joint);
  }
}

}  // namespace

Equation blocked_equation(const Transmission& transmission, const Transmission* preliminary,
                          bool sliding, double rest_speed, double still_speed, int joint) {
  const BlockedColumns c = blocked_columns(transmission).of_joint(joint);
  const auto own = static_cast<std::size_t>(joint);
  Equation equation;
  equation.name = "blocked";
  equation.columns.assign(static_cast<std::size_t>(c.count), "");
  equation.averaged.assign(static_cast<std::size_t>(c.count),
                           false);  // quasi-static: no difference
  const std::optional<Transmission> curve =
      preliminary ? std::optional(*preliminary) : std::nullopt;
  equation.fill = [transmission, c, curve, joint, own, rest_speed](
                      const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    const JointSignals& s = signals.joints[own];
    clear_others(c, out);
    fill_elongations(transmission, c, signals.joints, out);
    out.col(c.deflection) = transmission.deflections(joint, s.q, s.theta);
    elastic_basis(transmission, signals.joints, ElasticSide::motor, joint,
                  out.middleCols(c.basis, c.n_basis));
    out.col(c.offset).setOnes();
    // Decimated as the torque is: beside a reversal both pass through zero.
    out.col(c.direction) = branch(s, rest_speed);
    out.col(c.speed) = s.thetad;
    const Eigen::Index first_zero = c.zero - joint;
    if (curve)
      fill_zeros(*curve, signals.joints, joint, out.middleCols(first_zero, c.n_joints));
    else
      out.middleCols(first_zero, c.n_joints).setZero();
    out.col(c.tau) = s.tau;
  };
  const auto slow = [rest_speed](const JointSignals& s) {
    return (s.thetad.abs() < rest_speed).cast<double>().eval();
  };
  if (sliding) {
    equation.rest_speed = rest_speed;
    equation.speed = [own](const Signals& signals) { return signals.joints[own].thetad; };
  }
  equation.use = [sliding, slow, still_speed, own](const Signals& signals) -> Eigen::ArrayXd {
    const JointSignals& s = signals.joints[own];
    Eigen::ArrayXd use = (s.approach != 0.0).cast<double>();  // before the first motion: no branch
    if (!sliding) use *= slow(s);  // no row is slower than 0: then all count as sliding
    if (still_speed > 0) use *= (s.qd.abs() < still_speed).cast<double>();
    return use;
  };
  return equation;
}

}  // namespace cablefit
