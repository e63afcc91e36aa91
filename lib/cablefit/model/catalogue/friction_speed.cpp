#include <cmath>

#include "cablefit/model/catalogue/rows.hpp"

// Friction as a function of the axis' own speed. Whatever changes sign with the speed is a level of
// dry friction, so that a simulation solves it as one and never drives with it.
namespace cablefit::rows {
namespace {

constexpr ParameterInfo kAsymmetric[] = {
    {"coefficient", "a", "N m s/rad", "damping is f + a forwards, f - a backwards"}};
constexpr ParameterInfo kStribeck[] = {
    {"amplitude", "a", "N m", "dry friction at rest beyond that in motion", 0},
    {"v_s", "v_s", "rad/s", "speed at which it has fallen to 37 %", 1e-4},
    {"exponent", "s", "", "1: exponential, 2: Gaussian", 1, 2}};
constexpr ParameterInfo kDrag[] = {{"coefficient", "a", "N m", "torque at 1 rad/s", 0},
                                   {"exponent", "p", "", "2: quadratic", 1.5, 2.5}};
constexpr ParameterInfo kNonlinear[] = {
    {"coefficient", "a", "N m", "torque at 1 rad/s", 0},
    {"exponent", "p", "", "below 1: thins with speed", 0.25, 0.75}};

constexpr ShapeGrid kStribeckShape[] = {
    {.low = 0.008, .high = 0.5, .n_values = 9, .unit = GridUnit::speed},
    {.low = 1, .high = 2, .n_values = 2, .canonical = 2}};
constexpr ShapeGrid kDragShape[] = {
    {.low = 1.5, .high = 2.5, .n_values = 5, .is_geometric = false, .canonical = 2}};
constexpr ShapeGrid kNonlinearShape[] = {
    {.low = 0.25, .high = 0.75, .n_values = 3, .is_geometric = false}};

/// x^p for x >= 0; the powers of textbooks without std::pow, which is ten times slower.
double power(double x, double p) {
  if (p == 2) return x * x;
  return p == 1 ? x : std::pow(x, p);
}

template <Site kSide>
void absolute(const JointState& state, const double* /*shape*/, const double* /*z*/, double* link,
              double* motor) {
  own<kSide>(link, motor)[0] = std::abs(speed<kSide>(state));
}

template <Site kSide>
void stribeck_level(const JointState& state, double /*direction*/, const double* shape,
                    const double* /*z*/, double* level) {
  level[0] = std::exp(-power(std::abs(speed<kSide>(state)) / shape[0], shape[1]));
}

template <Site kSide>
void power_level(const JointState& state, double /*direction*/, const double* shape,
                 const double* /*z*/, double* level) {
  level[0] = power(std::abs(speed<kSide>(state)), shape[0]);
}

}  // namespace

Effect asymmetric_viscous(Site side) {
  constexpr TwoSides<std::string_view> kEquation{"a |qd|", "a |thetad|"};
  return {.name = "asymmetric_viscous",
          .site = side,
          .equation = kEquation.at(side),
          .signature = "even in speed; at one speed it is a constant torque",
          .experiment = "three speeds or more in each direction",
          .source = "Bittencourt et al. 2010",
          .parameters = kAsymmetric,
          .torque = side == Site::link ? absolute<Site::link> : absolute<Site::motor>};
}

Effect stribeck(Site side) {
  constexpr TwoSides<std::string_view> kEquation{"a exp(-|qd / v_s|^s) sgn(qd)",
                                                 "a exp(-|thetad / v_s|^s) sgn(thetad)"};
  return {.name = "stribeck",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "excess friction at low speed, in both directions; presliding depends on the "
              "distance since the last reversal instead, drag appears at high speed",
          .experiment = "slow sweeps at several constant speeds from 0.02 rad/s on",
          .source = "Armstrong-Helouvry, Dupont & Canudas de Wit 1994",
          .parameters = kStribeck,
          .shape = kStribeckShape,
          .level = side == Site::link ? stribeck_level<Site::link> : stribeck_level<Site::motor>};
}

Effect quadratic_drag(Site side) {
  constexpr TwoSides<std::string_view> kEquation{"a |qd|^p sgn(qd), p about 2",
                                                 "a |thetad|^p sgn(thetad), p about 2"};
  return {.name = "quadratic_drag",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "grows with the square of speed; over a small range of speed it is similar to "
              "viscous friction, or to Stribeck friction with less viscous friction",
          .experiment = "constant speeds over a range of five times or more",
          .source = "Armstrong-Helouvry, Dupont & Canudas de Wit 1994",
          .parameters = kDrag,
          .shape = kDragShape,
          .level = side == Site::link ? power_level<Site::link> : power_level<Site::motor>};
}

Effect nonlinear_viscous(Site side) {
  constexpr TwoSides<std::string_view> kEquation{"a |qd|^p sgn(qd), p < 1",
                                                 "a |thetad|^p sgn(thetad), p < 1"};
  return {.name = "nonlinear_viscous",
          .site = side,
          .equation = kEquation.at(side),
          .signature =
              "friction rises ever slower with speed, as grease that thins; Stribeck "
              "friction falls with speed instead",
          .experiment = "constant speeds over a range of five times or more",
          .source = "Wolf & Iskandar 2018",
          .parameters = kNonlinear,
          .shape = kNonlinearShape,
          .level = side == Site::link ? power_level<Site::link> : power_level<Site::motor>};
}

}  // namespace cablefit::rows
