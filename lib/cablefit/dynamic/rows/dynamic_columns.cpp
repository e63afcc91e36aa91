#include "cablefit/dynamic/rows/dynamic_columns.hpp"

#include <cmath>

#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/model/model.hpp"

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

/// Basis columns of a fit, n x coefficients.
void fill_basis(const ElasticFit& fit, const DynamicColumns& c, const Signals& signals,
                Eigen::Ref<Eigen::MatrixXd> out) {
  if (is_linear(fit)) {
    const JointSignals& s = signals.joints[static_cast<std::size_t>(c.place.joint)];
    if (out.cols() > 1) out.setZero();
    out.col(c.place.joint) = fit.transmission.deflections(c.place.joint, s.q, s.theta);
    if (c.side == Side::link)
      out.col(c.place.joint) *= fit.transmission.reductions()(c.place.joint);
  } else {
    elastic_basis(fit.transmission, signals.joints,
                  c.side == Side::link ? ElasticSide::link : ElasticSide::motor, c.place.joint,
                  out);
  }
}

void fill_elastic(const ElasticFit& fit, const DynamicColumns& c, const Signals& signals,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  if (c.detail == ElasticDetail::coefficients) return fill_basis(fit, c, signals, out);
  const Eigen::VectorXd coefficients = elastic_coefficients(fit);
  Eigen::MatrixXd basis(out.rows(), coefficients.size());
  fill_basis(fit, c, signals, basis);
  out.noalias() = basis * coefficients;
}

/// theta - N q, with the encoder zero.
Eigen::ArrayXd logged_deflection(const Transmission& transmission, int joint,
                                 const JointSignals& s) {
  return transmission.deflections(joint, s.q, s.theta) + transmission.encoder_zero()(joint);
}

/// Its loop goes with the direction in which the deflection changes.
void fill_misfit(const ElasticFit& fit, Side side, const JointSignals& s,
                 Eigen::Ref<Eigen::MatrixXd> out) {
  const Eigen::ArrayXd phi = fit.transmission.deflections(0, s.q, s.theta);
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    const MisfitPoint point = fit.misfit.at(phi(i));
    out(i, 0) = point.torque;
    out(i, 1) = s.thetad(i) < s.qd(i) ? -point.half_width : point.half_width;
  }
  if (side == Side::link) out *= fit.transmission.reductions()(0);
}

/// Its axis moves the links of an arm, or is one of them.
bool is_of_arm(const DynamicColumns& c) {
  return c.side != Side::motor && c.place.arm != nullptr && c.place.arm->is_coupled();
}

std::optional<double> given_inertia(const DynamicColumns& c, const Effect& effect, int joint) {
  if (c.side != Side::link || !effect.is_inertia() || c.place.arm == nullptr) return {};
  const std::vector<double>& given = c.place.arm->parameters.J_link;
  if (given.empty()) return {};
  return given[static_cast<std::size_t>(joint)];
}

/// Names the columns of the effects of one joint.
void add_effects(DynamicColumns& c, int joint) {
  if (joint == c.place.joint) c.first_effect = static_cast<Eigen::Index>(c.parameters.size());
  for (const Effect& effect : base_effects(c.side)) {
    const bool is_inertia = effect.is_inertia();
    if (is_inertia && is_of_arm(c)) continue;  // the arm's base parameters stand for it
    if (joint == c.place.joint) c.effects.push_back(&effect);
    const ParameterInfo& info = effect.parameters.front();
    c.parameters.push_back({info, joint_parameter_name(info.name, joint + 1, c.place.n_joints),
                            c.place.axes.of(joint), is_inertia, given_inertia(c, effect, joint),
                            effect.follows});
  }
}

/// What a joint has beyond (31).
void add_added(DynamicColumns& c, int joint, const EffectsPerJoint* added) {
  if (added == nullptr || static_cast<std::size_t>(joint) >= added->size()) return;
  for (AddedEffect& effect :
       effects_of_side((*added)[static_cast<std::size_t>(joint)], c.side, joint)) {
    for (DynamicParameter& p : parameters_of(effect, c.place.n_joints)) {
      p.axes = c.place.axes.of(joint);
      c.parameters.push_back(std::move(p));
    }
    c.added.push_back(std::move(effect));
  }
}

/// Of the joint alone.
void add_own_parameters(DynamicColumns& c, const EffectsPerJoint* added) {
  add_effects(c, c.place.joint);
  c.first_added = static_cast<Eigen::Index>(c.parameters.size());
  add_added(c, c.place.joint, added);
}

void add_parameters(DynamicColumns& c, const EffectsPerJoint* added) {
  if (!is_of_arm(c)) return add_own_parameters(c, added);
  for (const ParameterInfo& info : c.place.arm->base_parameters())
    c.parameters.push_back(
        {info, std::string(info.name), Axes::rotary, false, {}, MotionPart::joints});
  c.n_arm = static_cast<Eigen::Index>(c.parameters.size());
  for (int joint = 0; joint < c.place.n_joints; ++joint) add_effects(c, joint);
  c.first_added = static_cast<Eigen::Index>(c.parameters.size());
  for (int joint = 0; joint < c.place.n_joints; ++joint) add_added(c, joint, added);
}

Motion motion_of(Side side, const JointSignals& s) {
  return {position(side, s), velocity(side, s), acceleration(side, s),
          side == Side::link ? s.q_direction : s.theta_direction};
}

/// The columns of an arm's links, those of other joints' effects 0. `at`: see effect_columns().
void fill_arm(const DynamicColumns& c, const Signals& signals, std::size_t at,
              Eigen::Ref<Eigen::MatrixXd> out) {
  std::vector<Motion> links;
  const std::size_t first = at - static_cast<std::size_t>(c.place.joint);
  for (std::size_t k = 0; k < static_cast<std::size_t>(c.place.n_joints); ++k)
    links.push_back(motion_of(c.side, signals.joints[first + k]));
  out.setZero();
  c.place.arm->kind->regressor(c.place.arm->parameters, links, c.place.joint,
                               out.leftCols(c.n_arm));
}

/// The columns beyond (31) of the joint at place `at` of the signals. An arm's are 0 before.
void fill_added(const DynamicColumns& c, const Signals& signals, std::size_t at,
                Eigen::Ref<Eigen::MatrixXd> out) {
  if (c.added.empty()) return;
  const JointMotion motion = joint_motion(c.cables.get(), signals, at, c.place.joint, c.added);
  Eigen::Index first = c.first_added;
  for (const AddedEffect& effect : c.added) {
    if (effect.joint == c.place.joint)
      fill_columns(effect, motion, out.middleCols(first, effect.n_columns()));
    first += effect.n_columns();
  }
}

}  // namespace

Eigen::VectorXd elastic_coefficients(const ElasticFit& fit) {
  if (is_linear(fit)) return fit.transmission.linear_stiffness;
  Eigen::VectorXd all(n_elastic_columns(fit.transmission));
  Eigen::Index next = 0;
  for (const Cable& cable : fit.transmission.cables)
    for (const double coefficient : cable.coefficients) all(next++) = coefficient;
  return all;
}

DynamicColumns dynamic_columns(Side side, const std::vector<const ElasticFit*>& fits,
                               ElasticDetail detail, const JointPlace& place,
                               const AddedEffects& added) {
  DynamicColumns c;
  c.detail = detail;
  c.side = side;
  c.place = place;
  c.cables = added.cables;
  add_parameters(c, added.effects);
  if (!c.added.empty() && c.cables == nullptr && !fits.empty())
    c.cables = std::make_shared<const Transmission>(fits.front()->transmission);
  c.n_effects = static_cast<Eigen::Index>(c.parameters.size());
  c.count = c.n_effects;
  for (const ElasticFit* fit : fits) {
    c.elastic.push_back(c.count);
    c.n_elastic.push_back(detail == ElasticDetail::torque ? 1 : elastic_coefficients(*fit).size());
    c.count += c.n_elastic.back();
    const bool carried =
        detail == ElasticDetail::coefficients && place.n_joints == 1 && !fit->misfit.empty();
    c.misfit.push_back(carried ? c.count : -1);
    if (carried) c.count += 2;
  }
  if (!fits.empty()) c.deflection = c.count++;
  c.position = c.count++;
  c.torque = c.count++;
  return c;
}

MotionColumn motion_column(const DynamicColumns& columns, std::size_t parameter) {
  const DynamicParameter& p = columns.parameters[parameter];
  const bool weighted = columns.n_arm > 0;
  return {p.follows, weighted ? "" : motion_unit(p.follows, p.axes)};
}

void effect_columns(const DynamicColumns& c, const Signals& signals, std::size_t joint,
                    Eigen::Ref<Eigen::MatrixXd> out) {
  if (c.n_arm > 0) fill_arm(c, signals, joint, out);
  const Motion motion = motion_of(c.side, signals.joints[joint]);
  Eigen::Index first = c.first_effect;
  for (const Effect* effect : c.effects) fill_base_column(*effect, motion, out.col(first++));
  fill_added(c, signals, joint, out);
}

void take_values(const DynamicColumns& columns, const Eigen::VectorXd& x, EffectsPerJoint& added) {
  for (std::size_t k = 0; k < columns.parameters.size(); ++k) {
    const DynamicParameter& parameter = columns.parameters[k];
    const double found = x(static_cast<Eigen::Index>(k));
    Estimate* e = find_parameter(added, parameter.name);
    if (e != nullptr && !parameter.given && std::isfinite(found))
      e->value = parameter.origin + found;
  }
}

Equation dynamic_equation(const DynamicColumns& c, const std::vector<const ElasticFit*>& fits,
                          bool torque_held, double rest_speed) {
  Equation equation;
  equation.name = joint_parameter_name(to_string(c.side), c.place.joint + 1, c.place.n_joints);
  const auto own = static_cast<std::size_t>(c.place.joint);
  equation.columns.assign(static_cast<std::size_t>(c.count), "");
  equation.averaged.assign(static_cast<std::size_t>(c.count), true);
  // A held torque is exact as the mean of two samples; a measured one is averaged like everything
  // else.
  if (torque_held && c.side != Side::link)
    equation.averaged[static_cast<std::size_t>(c.torque)] = false;
  equation.rest_speed = rest_speed;
  equation.speed = [side = c.side, own](const Signals& signals) {
    return velocity(side, signals.joints[own]);
  };
  equation.fill = [c, fits, own](const Signals& signals, Eigen::Ref<Eigen::MatrixXd> out) {
    const JointSignals& s = signals.joints[own];
    effect_columns(c, signals, own, out.leftCols(c.n_effects));
    for (std::size_t k = 0; k < fits.size(); ++k) {
      fill_elastic(*fits[k], c, signals, out.middleCols(c.elastic[k], c.n_elastic[k]));
      if (c.misfit[k] >= 0) fill_misfit(*fits[k], c.side, s, out.middleCols(c.misfit[k], 2));
    }
    if (c.deflection >= 0)
      out.col(c.deflection) = logged_deflection(fits.front()->transmission, c.place.joint, s);
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
