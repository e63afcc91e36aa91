#include "cablefit/refine/rows/regime_variables.hpp"

namespace cablefit {
namespace {

constexpr RegimeVariable kVariables[] = {
    {"speed", "qd", "thetad", "rad/s",
     [](const JointState& s, bool link, double) { return link ? s.qd : s.thetad; }},
    {"direction", "sgn(qd)", "sgn(thetad)", "",
     [](const JointState& s, bool link, double) {
       return (link ? s.qd : s.thetad) < 0 ? -1.0 : 1.0;
     }},
    {"position", "q", "theta", "rad",
     [](const JointState& s, bool link, double) { return link ? s.q : s.theta; }},
    {"deflection", "theta - q", "theta - q", "rad",
     [](const JointState& s, bool, double) { return s.deflection; }},
    {"elastic torque", "tau_elas", "tau_elas", "N m",
     [](const JointState& s, bool, double) { return s.tau_elas + s.load; }},  // 0 on a rigid drive
    {"load", "tau_load", "tau_load", "N m",
     [](const JointState&, bool, double load) { return load; }},
    {"time", "t", "t", "s", [](const JointState& s, bool, double) { return s.t; }},
};

}  // namespace

std::span<const RegimeVariable> regime_variables() { return kVariables; }

double value_at(const RegimeVariable& variable, const Design& design, std::size_t stretch,
                RowKind kind, Eigen::Index sample) {
  const JointState& state = design.states[stretch][static_cast<std::size_t>(sample)];
  return variable.value(state, kind == RowKind::link,
                        design.rows[stretch].motion->tau_load(sample));
}

std::string regime_unit(std::string_view regime, Axes axes) {
  for (const RegimeVariable& variable : kVariables)
    if (variable.regime == regime) return unit_for(axes, variable.unit);
  return "";
}

}  // namespace cablefit
