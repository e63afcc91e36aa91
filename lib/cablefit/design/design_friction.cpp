#include "cablefit/design/design_friction.hpp"

#include <algorithm>
#include <array>

namespace cablefit {
namespace {

constexpr std::size_t kMostLinear = 64;  // parameters of one row of the catalogue

std::vector<double> values_of(const std::vector<Estimate>& parameters) {
  std::vector<double> values;
  for (const Estimate& p : parameters) values.push_back(p.value);
  return values;
}

double level_of(const std::vector<EffectInstance>& effects) {
  double sum = 0;
  for (const EffectInstance& e : effects)
    if (e.effect->follows == MotionPart::direction) sum += e.parameters.front().value;
  return sum;
}

double level_of(const EffectInstance& instance, const JointState& state, double direction) {
  const Effect& row = *instance.effect;
  if (row.level == nullptr) return 0;
  const std::vector<double> values = values_of(instance.parameters);
  std::array<double, kMostLinear> per_unit{};
  const std::vector<double> no_states(row.n_states, 0.0);
  row.level(state, direction, values.data() + row.n_linear(), no_states.data(), per_unit.data());
  double sum = 0;
  for (std::size_t j = 0; j < row.n_linear(); ++j) sum += values[j] * per_unit[j];
  return sum;
}

/// Some effect of the joint has a dry level that depends on the cables' tension.
bool follows_tension(const Model& model, int joint) {
  if (model.joints.empty()) return false;
  JointState slack, taut;
  taut.tension = 1;
  for (const EffectInstance& e : model.joints[static_cast<std::size_t>(joint)].added)
    if (level_of(e, taut, 1) != level_of(e, slack, 1)) return true;
  return false;
}

void add_efficiencies(double torque, DesignFriction& friction) {
  const auto driving = [&](double f) { return torque / (torque + f); };
  friction.efficiency_driving = driving(friction.driving);
  friction.efficiency_driven = std::max(0.0, (torque - friction.driven) / torque);
  const double load = friction.driving - friction.at_rest;
  friction.efficiency_low = driving(friction.high + load);
  friction.efficiency_high = driving(friction.low + load);
}

void add_parts(const JointCurve& curve, double l_o, double tension,
               std::span<const FrictionCurve> curves, DesignFriction& friction) {
  for (const FrictionCurve& one : curves) {
    if (one.joint != curve.joint() || one.name == kDryFriction) continue;
    if (const auto value = one.at(l_o, tension))
      friction.parts.push_back({one.name, one.unit, *value});
  }
}

/// The level that the fitted preloads say, and what the load adds by the model.
void take_fitted(const FrictionValue& dry, DesignFriction& friction) {
  const double other = dry.value - friction.at_rest;
  friction.at_rest += other;
  friction.driving += other;
  friction.driven += other;
  friction.sd = dry.sd;
  friction.low = dry.low;
  friction.high = dry.high;
}

}  // namespace

double friction_at(const Model& model, const JointCurve& curve, double phi, double direction,
                   double tension_friction) {
  double sum = tension_friction * curve.tension_at_pulleys(phi);
  if (model.joints.empty()) return sum;
  const JointModel& joint = model.joints[static_cast<std::size_t>(curve.joint())];
  JointState state;
  set_elastic(curve.transmission(), curve.q(), curve.theta(phi), curve.joint(), state);
  state.q = curve.q()(curve.joint());
  state.theta = curve.theta(phi)(curve.joint());
  sum += level_of(joint.link) + level_of(joint.motor);
  for (const EffectInstance& more : joint.added) sum += level_of(more, state, direction);
  return sum;
}

std::optional<DesignFriction> design_friction(const Model& model, const JointCurve& curve,
                                              double torque, std::optional<double> tension_friction,
                                              std::span<const FrictionCurve> curves) {
  const double mu = tension_friction.value_or(0);
  const double loaded = curve.deflection_at(torque).value_or(0);
  DesignFriction friction;
  friction.at_rest = friction_at(model, curve, 0, 1, mu);
  friction.driving = friction_at(model, curve, loaded, 1, mu);
  friction.driven = friction_at(model, curve, loaded, -1, mu);
  if (!tension_friction && !follows_tension(model, curve.joint())) {
    const double l_o = curve.transmission().cables.front().initial_elongation;
    const double tension = curve.tension_at_pulleys(0);
    const FrictionCurve* dry = find_curve(curves, curve.joint(), kDryFriction);
    const auto value = dry != nullptr ? dry->at(l_o, tension) : std::nullopt;
    if (!value) return std::nullopt;
    take_fitted(*value, friction);
    add_parts(curve, l_o, tension, curves, friction);
  }
  add_efficiencies(torque, friction);
  return friction;
}

}  // namespace cablefit
