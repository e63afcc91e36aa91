#include <cmath>
#include <numbers>

#include "cablefit/model/catalogue/rows.hpp"

// What happens once.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kSlip[] = {{"slip", "a", "rad", "deflection is logged + a after it"}};
constexpr ParameterInfo kContact[] = {{"torque", "a", "N m", "largest contact torque on the link"},
                                      {"width", "w", "s", "how long it lasts", 1e-3}};
constexpr ParameterInfo kPayload[] = {{"inertia", "dJ", "kg m^2", "more inertia of the link"},
                                      {"a_cos", "a_cos", "N m", "more gravity, with cos(q)"},
                                      {"a_sin", "a_sin", "N m", "more gravity, with sin(q)"}};
constexpr ShapeGrid kWidth[] = {{.low = 0.1, .high = 0.5, .n_values = 4}};

void slipped(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
             double* motor) {
  pull(state.since_event >= 0 ? state.stiffness : 0, 0, link, motor);
}

void push(const JointState& state, const double* shape, const double* /*z*/, double* link,
          double* /*motor*/) {
  const double x = state.since_event / shape[0];
  link[0] = x > 0 && x < 1 ? 0.5 * (std::cos(2 * std::numbers::pi * x) - 1) : 0;
}

void carry(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
           double* /*motor*/) {
  if (state.since_event < 0) return;
  link[0] = state.qdd;
  link[1] = std::cos(state.q);
  link[2] = std::sin(state.q);
}

}  // namespace

Effect slip() {
  return {.name = "slip",
          .site = Site::transmission,
          .equation = "tau_elas(phi + a) - tau_elas(phi) = k a from t_0 on",
          .signature =
              "a lasting step of the deflection, opposite on the two sides; an encoder "
              "offset is there from the start, creep reverses with the load",
          .experiment = "the same pose before and after it",
          .source = "Fichera & Grossard 2017, Assumption 1",
          .parameters = kSlip,
          .is_event = true,
          .is_static = true,
          .torque = slipped,
          .steps_deflection = true};
}

Effect contact() {
  return {.name = "contact",
          .site = Site::link,
          .equation = "-a (1 - cos(2 pi (t - t_0) / w)) / 2 for w seconds",
          .signature =
              "a short torque in the link equation only; a low-frequency disturbance looks "
              "like some contacts",
          .experiment = "the same motion again, without contact",
          .source = "De Luca & Mattone 2005",
          .parameters = kContact,
          .shape = kWidth,
          .is_event = true,
          .torque = push};
}

Effect payload_change() {
  return {.name = "payload_change",
          .site = Site::link,
          .equation = "dJ qdd + a_cos cos(q) + a_sin sin(q) from t_0 on",
          .signature =
              "more inertia and gravity in the link equation from a time on; a slip is in "
              "the motor equation as well",
          .experiment = "the same motion before and after it",
          .source = "Khalil & Dombre 2002",
          .parameters = kPayload,
          .is_event = true,
          .torque = carry};
}

}  // namespace cablefit::rows
