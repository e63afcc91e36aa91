// Friction that is no straight line in speed: rows that are not affine, made up for the test.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

Effect made_up(double (*smooth)(double, double, const double*),
               double (*dry)(double, double, const double*)) {
  Effect effect = find_effect("viscous", Side::rigid);
  effect.smooth = smooth;
  effect.dry = dry;
  effect.is_affine = false;
  return effect;
}

double cubic(double /*x*/, double v, const double* c) { return c[0] * v * v * v; }

/// Largest error of the speed over 1 s of J v' = -c v^3: v = v0 / sqrt(1 + 2 c v0^2 t / J).
double cubic_error(double step) {
  const Effect effect = made_up(cubic, nullptr);
  const double inertia = 0.2, coefficient = 0.15, v0 = 4;
  Model model = rigid_drive({inertia, 0, 0, 0});
  model.joints[0].motor[1] = {&effect, model.joints[0].motor[1].parameters};
  model.joints[0].motor[1].parameters[0].value = coefficient;
  SimulationInput input = quiet_input(101, 0.01);
  input.thetad0[0] = v0;
  const SimulationResult result = simulate(model, input, step_of(step));
  double largest = 0;
  for (Eigen::Index i = 0; i < 101; ++i) {
    const double t = 0.01 * static_cast<double>(i);
    const double exact = v0 / std::sqrt(1 + 2 * coefficient * v0 * v0 * t / inertia);
    largest = std::max(largest, std::abs(result.thetad(i, 0) - exact));
  }
  return largest;
}

TEST_CASE("cubic drag converges to its closed form with order 2", "[simulate]") {
  const std::vector<double> errors{cubic_error(1e-3), cubic_error(5e-4), cubic_error(2.5e-4)};
  // v' / v is at most 12 / s, so the next term is 12 h ~ 1e-2 smaller.
  CHECK(std::abs(convergence_order(errors) - 2) < 0.03);
}

double weakening(double /*x*/, double v, const double* level) {
  return level[0] * (1 + std::exp(-std::abs(v) / 0.05));
}

TEST_CASE("dry friction that weakens with speed holds more at rest than in motion", "[simulate]") {
  const Effect effect = made_up(nullptr, weakening);
  Model model = rigid_drive({0.2, 0, 0, 0});
  model.joints[0].motor[1] = {&effect, model.joints[0].motor[1].parameters};
  model.joints[0].motor[1].parameters[0].value = 1.5;  // 3 N m at rest, 1.5 N m at speed
  SimulationInput input = quiet_input(100, 1e-3);
  input.tau.setConstant(2.999);
  CHECK((simulate(model, input, {}).theta == 0).all());
  input.thetad0[0] = 10;
  // exp(-200) is nothing: the torque that is left is 1.499 N m.
  CHECK(simulate(model, input, {}).thetad(99, 0) == Approx(10 + 1.499 / 0.2 * 0.099).epsilon(1e-9));
}

TEST_CASE("an affine row simulated as any other gives the same motion", "[simulate]") {
  Model model = paper_rig_low();
  SimulationInput input = quiet_input(500, 1e-3);
  for (Eigen::Index i = 0; i < 500; ++i) {
    input.tau(i, 0) = 25 * std::sin(0.04 * static_cast<double>(i));
  }
  const SimulationResult folded = simulate(model, input, {});
  std::vector<Effect> copies;
  copies.reserve(7);
  for (auto* axis : {&model.joints[0].link, &model.joints[0].motor}) {
    for (EffectInstance& instance : *axis) {
      copies.push_back(*instance.effect);
      copies.back().is_affine = false;
      instance.effect = &copies.back();
    }
  }
  const SimulationResult generic = simulate(model, input, {});
  // The numeric slope is off by rounding, 1e-10 of it.
  CHECK((generic.q - folded.q).abs().maxCoeff() < 1e-9);
  CHECK(folded.q.abs().maxCoeff() > 0.01);
}

}  // namespace
