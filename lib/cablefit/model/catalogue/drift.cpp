#include "cablefit/model/catalogue/rows.hpp"

// What settles as the drive runs.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kFriction[] = {
    {"damping", "a_v", "N m s/rad", "change of viscous friction; negative: it falls"},
    {"amplitude", "a_s", "N m", "change of dry friction; negative: it falls"},
    {"T", "T", "s", "time constant (63 %)", 1e-3}};
constexpr ParameterInfo kOffset[] = {{"amplitude", "a", "N m", "change of torque"},
                                     {"T", "T", "s", "time constant (63 %)", 1e-3}};

constexpr ShapeGrid kTime[] = {{.low = 2, .high = 30, .n_values = 6}};

template <Site kSide>
void viscous_part(const JointState& state, const double* shape, const double* /*z*/, double* link,
                  double* motor) {
  own<kSide>(link, motor)[0] = settled(state.t, shape[0]) * speed<kSide>(state);
}

void dry_part(const JointState& state, double /*direction*/, const double* shape,
              const double* /*z*/, double* level) {
  level[1] = settled(state.t, shape[0]);
}

void offset(const JointState& state, const double* shape, const double* /*z*/, double* /*link*/,
            double* motor) {
  motor[0] = settled(state.t, shape[0]);
}

}  // namespace

Effect friction_drift(Site side) {
  constexpr TwoSides<std::string_view> kEquation{
      "(a_v qd + a_s sgn(qd)) (1 - exp(-t / T))",
      "(a_v thetad + a_s sgn(thetad)) (1 - exp(-t / T))"};
  return {.name = "friction_drift",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "friction that falls (or rises) as the drive warms up; creep and offset "
              "drift do not change sign with direction",
          .experiment = "the same motion at the beginning and at the end of a log",
          .source = "Bittencourt et al. 2010",
          .parameters = kFriction,
          .shape = kTime,
          .torque = side == Site::link ? viscous_part<Site::link> : viscous_part<Site::motor>,
          .level = dry_part};
}

Effect offset_drift() {
  return {.name = "offset_drift",
          .site = Site::sensor,
          .equation = "a (1 - exp(-t / T)) on the motor",
          .signature =
              "a slowly changing constant in the motor equation only, independent of the "
              "motion",
          .experiment = "standstill at the beginning and at the end of a log",
          .source = "zero drift of current sensors and amplifiers",
          .parameters = kOffset,
          .shape = kTime,
          .torque = offset};
}

}  // namespace cablefit::rows
