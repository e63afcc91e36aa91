#include "step.hpp"

namespace hidden {
namespace {

Slide from_rest(double J, double f, double torque, double down, double up, double h) {
  const double net = torque > up ? torque - up : torque < -down ? torque + down : 0;
  const double v = net * h / (J + 0.5 * f * h);
  return {v, 0.5 * h * v};
}

}  // namespace

Slide slide(double v, double J, double f, double torque, double down, double up, double h) {
  if (v == 0) return from_rest(J, f, torque, down, up, h);
  const double net = torque - (v > 0 ? up : -down);
  const double v1 = ((J - 0.5 * f * h) * v + net * h) / (J + 0.5 * f * h);
  if (v1 * v > 0) return {v1, 0.5 * h * (v + v1)};
  const double until = h * v / (v - v1);
  const Slide after = from_rest(J, f, torque, down, up, h - until);
  return {after.v, 0.5 * until * v + after.dx};
}

}  // namespace hidden
