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

/// At the deflection phi, moving slowly in this direction.
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

}  // namespace

std::optional<DesignFriction> design_friction(const Model& model, const JointCurve& curve,
                                              double torque,
                                              std::optional<double> tension_friction) {
  if (model.joints.empty() && !tension_friction) return std::nullopt;
  const double mu = tension_friction.value_or(0);
  const double loaded = curve.deflection_at(torque).value_or(0);
  DesignFriction friction;
  friction.at_rest = friction_at(model, curve, 0, 1, mu);
  friction.driving = friction_at(model, curve, loaded, 1, mu);
  friction.driven = friction_at(model, curve, loaded, -1, mu);
  friction.efficiency_driving = torque / (torque + friction.driving);
  friction.efficiency_driven = std::max(0.0, (torque - friction.driven) / torque);
  return friction;
}

}  // namespace cablefit
