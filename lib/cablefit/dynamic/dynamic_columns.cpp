#include "cablefit/dynamic/dynamic_columns.hpp"

namespace cablefit {
namespace {

const Eigen::ArrayXd& position(Side side, const JointSignals& s) {
  return side == Side::link ? s.q : s.theta;
}
const Eigen::ArrayXd& velocity(Side side, const JointSignals& s) {
  return side == Side::link ? s.qd : s.thetad;
}
const Eigen::ArrayXd& acceleration(Side side, const JointSignals& s) {
  return side == Side::link ? s.qdd : s.thetadd;
}

bool is_linear(const ElasticFit& fit) { return fit.transmission.cables.empty(); }

/// Basis columns of a fit, n x coefficients.
void fill_basis(const ElasticFit& fit, Side side, const JointSignals& s,
                Eigen::Ref<Eigen::MatrixXd> out) {
  if (is_linear(fit)) {
    out.col(0) = s.theta - fit.transmission.theta_0(0) - s.q;
  } else {
    elastic_basis(fit.transmission, s, side == Side::link ? ElasticSide::link : ElasticSide::motor,
                  out);
  }
}

void fill_elastic(const ElasticFit& fit, Side side, const JointSignals& s, ElasticDetail detail,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  if (detail == ElasticDetail::coefficients) return fill_basis(fit, side, s, out);
  const Eigen::VectorXd coefficients = elastic_coefficients(fit);
  Eigen::MatrixXd basis(out.rows(), coefficients.size());
  fill_basis(fit, side, s, basis);
  out.noalias() = basis * coefficients;
}

}  // namespace

Eigen::VectorXd elastic_coefficients(const ElasticFit& fit) {
  if (is_linear(fit)) return fit.transmission.linear_stiffness.head(1);
  Eigen::VectorXd all(n_elastic_columns(fit.transmission));
  Eigen::Index next = 0;
  for (const Cable& cable : fit.transmission.cables)
    for (const double coefficient : cable.coefficients) all(next++) = coefficient;
  return all;
}

DynamicColumns dynamic_columns(Side side, const std::vector<const ElasticFit*>& fits,
                               ElasticDetail detail) {
  DynamicColumns c;
  c.detail = detail;
  c.side = side;
  for (const Effect& effect : base_effects(side)) {
    c.effects.push_back(&effect);
    c.n_effects += static_cast<Eigen::Index>(effect.parameters.size());
  }
  c.count = c.n_effects;
  for (const ElasticFit* fit : fits) {
    c.elastic.push_back(c.count);
    c.n_elastic.push_back(detail == ElasticDetail::torque ? 1 : elastic_coefficients(*fit).size());
    c.count += c.n_elastic.back();
  }
  if (!fits.empty()) c.deflection = c.count++;
  c.position = c.count++;
  c.torque = c.count++;
  return c;
}

void effect_columns(const std::vector<const Effect*>& effects, Side side, const JointSignals& s,
                    Eigen::Ref<Eigen::MatrixXd> out) {
  const Eigen::ArrayXd& direction = side == Side::link ? s.q_direction : s.theta_direction;
  const Motion motion{position(side, s), velocity(side, s), acceleration(side, s), direction};
  Eigen::Index first = 0;
  for (const Effect* effect : effects) {
    const auto n = static_cast<Eigen::Index>(effect->parameters.size());
    effect->regressor(motion, out.middleCols(first, n));
    first += n;
  }
}

Equation dynamic_equation(const DynamicColumns& c, const std::vector<const ElasticFit*>& fits,
                          bool torque_held, double rest_speed) {
  Equation equation;
  equation.name = to_string(c.side);
  equation.columns.assign(static_cast<std::size_t>(c.count), "");
  equation.averaged.assign(static_cast<std::size_t>(c.count), true);
  // A held torque is exact as the mean of two samples; a measured one is averaged like everything
  // else.
  if (torque_held && c.side != Side::link)
    equation.averaged[static_cast<std::size_t>(c.torque)] = false;
  equation.rest_speed = rest_speed;
  equation.speed = [side = c.side](const Signals& signals) {
    return velocity(side, signals.joints[0]);
  };
  equation.fill = [c, fits](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    const JointSignals& s = signals.joints[0];
    effect_columns(c.effects, c.side, s, out.leftCols(c.n_effects));
    for (std::size_t k = 0; k < fits.size(); ++k)
      fill_elastic(*fits[k], c.side, s, c.detail, out.middleCols(c.elastic[k], c.n_elastic[k]));
    if (c.deflection >= 0) out.col(c.deflection) = s.theta - s.q;
    out.col(c.position) = position(c.side, s);
    out.col(c.torque).setZero();
    if (c.side != Side::link) out.col(c.torque) = s.tau;
    // A load on the link, or directly on the axis of a rigid drive, stands on the side of the
    // torque.
    if (c.side != Side::motor && s.tau_load.size() > 0) out.col(c.torque).array() += s.tau_load;
  };
  return equation;
}

Eigen::VectorXd dynamic_response(const DynamicColumns& c,
                                 const std::vector<const ElasticFit*>& fits, std::size_t which) {
  Eigen::VectorXd response = Eigen::VectorXd::Unit(c.count, c.torque);
  if (fits.empty()) return response;
  const double sign = c.side == Side::link ? 1.0 : -1.0;
  if (c.detail == ElasticDetail::torque) {
    response(c.elastic[which]) = sign;
  } else {
    response.segment(c.elastic[which], c.n_elastic[which]) =
        sign * elastic_coefficients(*fits[which]);
  }
  return response;
}

}  // namespace cablefit
