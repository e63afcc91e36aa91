#include "cablefit/model/catalogue/rows.hpp"

// What repeats with the angle. Two harmonics each, so that a form that is no sine is named as well.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kImbalance[] = {{"a_sin", "a_sin", "N m", "with sin(q)"},
                                        {"a_cos", "a_cos", "N m", "with cos(q)"},
                                        {"b_sin", "b_sin", "N m", "with sin(2 q)"},
                                        {"b_cos", "b_cos", "N m", "with cos(2 q)"}};
constexpr ParameterInfo kCogging[] = {
    {"a_sin", "a_sin", "N m", "with sin(n theta)"},
    {"a_cos", "a_cos", "N m", "with cos(n theta)"},
    {"b_sin", "b_sin", "N m", "with sin(2 n theta)"},
    {"b_cos", "b_cos", "N m", "with cos(2 n theta)"},
    {"order", "n", "1/rad", "periods per turn after the reduction, any number", 0}};
constexpr ParameterInfo kEccentricity[] = {{"a_sin", "a_sin", "rad", "deflection with sin(q)"},
                                           {"a_cos", "a_cos", "rad", "deflection with cos(q)"},
                                           {"b_sin", "b_sin", "rad", "deflection with sin(2 q)"},
                                           {"b_cos", "b_cos", "rad", "deflection with cos(2 q)"}};

// Three to twenty periods over the range: with fewer any smooth curve passes for them, as what a
// wrong torque constant leaves. Orders whose phases at the ends of half the range are 0.6 rad apart
// are all but the same. A motor behind a reduction has its poles and screw turns far above: these
// are lines of a spectrum, too narrow for a grid.
constexpr ShapeGrid kOrder[] = {{.low = 9.4,
                                 .high = 62,
                                 .n_values = 89,
                                 .is_geometric = false,
                                 .unit = GridUnit::per_travel,
                                 .n_lines = 3}};

void gravity(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
             double* /*motor*/) {
  two_harmonics(state.q, link);
}

void ripple(const JointState& state, const double* shape, const double* /*z*/, double* /*link*/,
            double* motor) {
  two_harmonics(shape[0] * state.theta, motor);
}

void eccentricity(const JointState& state, const double* /*shape*/, const double* /*z*/,
                  double* link, double* motor) {
  double f[4];
  two_harmonics(state.q, f);
  for (std::size_t i = 0; i < 4; ++i) pull(state.stiffness * f[i], i, link, motor);
}

}  // namespace

Effect gravity_imbalance() {
  return {.name = "gravity_imbalance",
          .site = Site::link,
          .equation = "a_sin sin(q) + a_cos cos(q) + b_sin sin(2 q) + b_cos cos(2 q)",
          .signature =
              "a function of q in the link equation only, independent of speed and "
              "direction; similar to a wrong load law, or eccentric pulleys under one load",
          .experiment = "a slow sweep over more than 0.5 rad without load, both directions",
          .source = "Khalil & Dombre 2002",
          .parameters = kImbalance,
          .n_harmonics = 2,
          .torque = gravity};
}

Effect cogging() {
  return {.name = "cogging",
          .site = Site::motor,
          .equation =
              "a_sin sin(n theta) + a_cos cos(n theta) + b_sin sin(2 n theta) + b_cos "
              "cos(2 n theta)",
          .signature =
              "a line in the order spectrum over theta, the same sign in both "
              "directions; position friction changes sign with direction",
          .experiment = "slow passes at constant speed, both directions",
          .source = "Holtz & Springob 1996",
          .parameters = kCogging,
          .shape = kOrder,
          .n_harmonics = 2,
          .is_static = true,
          .torque = ripple};
}

Effect pulley_eccentricity() {
  return {.name = "pulley_eccentricity",
          .site = Site::transmission,
          .equation =
              "tau_elas(phi + f) - tau_elas(phi) = k f, f = a_sin sin(q) + a_cos cos(q) + "
              "b_sin sin(2 q) + b_cos cos(2 q)",
          .signature =
              "a function of q that grows with the stiffness, opposite in the link and motor "
              "equations; gravity is in the link equation only",
          .experiment = "the same slow sweep over q under two loads",
          .source = "Fichera & Grossard 2017, (3)-(4), with a radius that varies",
          .parameters = kEccentricity,
          .n_harmonics = 2,
          .torque = eccentricity};
}

}  // namespace cablefit::rows
