#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

// Dry friction that depends on where the axis is, and on where it last turned round.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kPosition[] = {
    {"a_sin", "a_sin", "N m", "with the sine"},
    {"a_cos", "a_cos", "N m", "with the cosine"},
    {"order", "n", "1/rad", "periods per turn of the joint, any number", 0}};
constexpr ParameterInfo kPresliding[] = {
    {"amplitude", "a", "N m",
     "part of the dry friction that builds up by presliding, at most all of it", 0},
    {"distance", "d", "rad", "distance after which 63 % of it has built up", 1e-6}};

// One and a half to eight periods over the range: with fewer any smooth function of position passes
// for them, as friction that grows with a load that depends on position.
constexpr ShapeGrid kOrder[] = {
    {.low = 4.7, .high = 25, .n_values = 35, .is_geometric = false, .unit = GridUnit::per_travel}};
constexpr ShapeGrid kDistance[] = {{.low = 0.2e-3, .high = 20e-3, .n_values = 9}};

template <Site kSide>
void position_level(const JointState& state, double /*direction*/, const double* shape,
                    const double* /*z*/, double* level) {
  const double x = shape[0] * position<kSide>(state);
  level[0] = std::sin(x);
  level[1] = std::cos(x);
}

template <Site kSide>
void slide(const JointState& state, const double* shape, double h, double* z) {
  z[0] = slid(z[0], speed<kSide>(state) * h, shape[0]);
}

template <Site kSide>
void spring(const JointState& /*state*/, const double* /*shape*/, const double* z, double* link,
            double* motor) {
  own<kSide>(link, motor)[0] = z[0];
}

void less_dry(const JointState& /*state*/, double /*direction*/, const double* /*shape*/,
              const double* /*z*/, double* level) {
  level[0] = -1;
}

}  // namespace

Effect position_friction(Site side) {
  constexpr TwoSides<std::string_view> kEquation{
      "(a_sin sin(n q) + a_cos cos(n q)) sgn(qd)",
      "(a_sin sin(n theta) + a_cos cos(n theta)) sgn(thetad)"};
  return {.name = "position_friction",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "a function of position that changes sign with direction; gravity and "
              "cogging do not, tension friction does so under a load that varies with q",
          .experiment = "the same slow sweep in both directions",
          .source = "Bittencourt et al. 2010",
          .parameters = kPosition,
          .shape = kOrder,
          .n_harmonics = 1,
          .level = side == Site::link ? position_level<Site::link> : position_level<Site::motor>};
}

Effect presliding(Site side) {
  constexpr TwoSides<std::string_view> kEquation{
      "a (z - sgn(qd)), dz/dq = (1 - z sgn(qd)) / d",
      "a (z - sgn(thetad)), dz/dtheta = (1 - z sgn(thetad)) / d"};
  return {.name = "presliding",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "a loop after each reversal, the same at any speed; Stribeck friction and "
              "delays depend on speed, cable hysteresis on the deflection",
          .experiment = "many small reversals, of 1 to 20 mrad, at two speeds",
          .source = "Dahl 1968",
          .parameters = kPresliding,
          .shape = kDistance,
          .n_states = 1,
          .advance = side == Site::link ? slide<Site::link> : slide<Site::motor>,
          .torque = side == Site::link ? spring<Site::link> : spring<Site::motor>,
          .level = less_dry,
          .takes_dry_friction = true};
}

}  // namespace cablefit::rows
