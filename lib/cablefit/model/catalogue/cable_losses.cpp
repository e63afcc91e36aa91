#include "cablefit/model/catalogue/rows.hpp"

// Cables that take energy: with the rate of the deflection, with its way, with time.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kDamping[] = {{"damping", "d", "N m s/rad", "of the cables", 0}};
constexpr ParameterInfo kHysteresis[] = {
    {"amplitude", "a", "N m", "torque of the friction between wires", 0},
    {"yield", "y", "rad", "deflection at which 63 % of it has built up", 1e-7}};
constexpr ParameterInfo kCreep[] = {
    {"compliance", "a", "rad/(N m)", "creep compliance; times the stiffness: a fraction", 0},
    {"T", "T", "s", "time constant (63 %)", 1e-3},
    {"settled", "s", "", "share of the first load at which the log begins settled; 0: unloaded", 0,
     1}};

constexpr ShapeGrid kYield[] = {
    {.low = 0.006, .high = 0.2, .n_values = 9, .unit = GridUnit::deflection}};
// What takes longer is no creep of a cable under a load that changes within seconds.
constexpr ShapeGrid kTime[] = {{.low = 0.3, .high = 10, .n_values = 8, .is_open_above = true},
                               {.low = 0, .high = 1, .n_values = 2, .is_geometric = false}};

void damp(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
          double* motor) {
  pull(state.deflection_rate, 0, link, motor);
}

void yield(const JointState& state, const double* shape, double h, double* z) {
  z[0] = slid(z[0], state.deflection_rate * h, shape[0]);
}

void hold(const JointState& /*state*/, const double* /*shape*/, const double* z, double* link,
          double* motor) {
  pull(z[0], 0, link, motor);
}

// z: the torque that they have settled under, and whether the log has begun. Exact for a torque
// that is constant over h.
void settle(const JointState& state, const double* shape, double h, double* z) {
  if (z[1] == 0) {
    z[0] = shape[1] * state.tau_elas;
    z[1] = 1;
  }
  z[0] += (state.tau_elas - z[0]) * settled(h, shape[0]);
}

// tau_elas(phi - a z) to first order.
void give_way(const JointState& state, const double* /*shape*/, const double* z, double* link,
              double* motor) {
  pull(-state.stiffness * z[0], 0, link, motor);
}

}  // namespace

Effect cable_damping() {
  return {.name = "cable_damping",
          .site = Site::transmission,
          .equation = "d phid on the motor, -d phid on the link",
          .signature =
              "opposite on the two sides, proportional to the rate of the deflection; "
              "similar to a delay of the link's encoder, which is proportional to the speed "
              "of the link",
          .experiment = "a dither near the resonance, at rest and during a fast motion",
          .source = "Fichera & Grossard 2017, Assumption 1, which leaves it out",
          .parameters = kDamping,
          .torque = damp};
}

Effect cable_hysteresis() {
  return {.name = "cable_hysteresis",
          .site = Site::transmission,
          .equation = "a z on the motor, -a z on the link, dz/dphi = (1 - z sgn(phid)) / y",
          .signature =
              "a loop of torque over deflection, also with the link blocked, the same at any "
              "rate; damping depends on the rate, presliding on the motion of one axis",
          .experiment = "blocked link, slow loops of two sizes at two rates",
          .source = "Bouc 1967; Wen 1976; Do, Tjahjowidodo et al. 2015",
          .parameters = kHysteresis,
          .shape = kYield,
          .is_static = true,
          .n_states = 1,
          .advance = yield,
          .torque = hold};
}

Effect creep() {
  return {.name = "creep",
          .site = Site::transmission,
          .equation = "tau_elas(phi - a c) - tau_elas(phi) = -k a c, dc/dt = (tau_elas - c) / T",
          .signature =
              "the deflection follows the history of the load, on both sides; hysteresis "
              "does not relax, a slip stays",
          .experiment = "steps of load, each held for several T",
          .source = "Zener 1948 (standard linear solid)",
          .parameters = kCreep,
          .shape = kTime,
          .is_static = true,
          .n_states = 2,
          .advance = settle,
          .torque = give_way};
}

}  // namespace cablefit::rows
