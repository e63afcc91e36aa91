// The simulator against physics that can be computed without it.
#include "simulate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <ctime>

using namespace hidden;

namespace {

Run still(double seconds) {
  Run run;
  run.name = "still";
  run.reference.assign(static_cast<std::size_t>(seconds * kRate), 0.0);
  return run;
}

Run moving(double seconds, const Bench& bench) {
  Run run;
  run.name = "moving";
  run.load = 20;
  run.reference = multisine({seconds, 0.05, 1.5, 0.3, 0.5, 5, 7}, bench);
  return run;
}

/// No friction, no offset, next to no controller, no counts.
Bench frictionless() {
  Bench bench;
  bench.rig.f_v = bench.rig.f_s = bench.rig.f_vm = bench.rig.f_sm = bench.rig.offset = 0;
  bench.kp = 1e-9;
  bench.kd = 0;
  bench.quantum_q = bench.quantum_theta = bench.noise_tau = 0;
  return bench;
}

Hooks push_link(double torque, double from, double to) {
  Hooks hooks;
  hooks.sides = [=](const State& s, Sides& sides) {
    if (s.t >= from && s.t < to) sides.link.torque -= torque;
  };
  return hooks;
}

/// Strain energy of both cables, J: the integral of c0 l + c1 l^2.
double strain_energy(const Rig& rig, double phi) {
  const auto of = [](const Cable& c, double l) {
    return l > 0 ? c.c[0] * l * l / 2 + c.c[1] * l * l * l / 3 : 0;
  };
  return of(rig.cable_1, phi + rig.cable_1.l_o) + of(rig.cable_2, rig.cable_2.l_o - phi);
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
  return worst;
}

}  // namespace

TEST_CASE("what conserves energy in the rig conserves it in the simulation") {
  Bench bench = frictionless();
  bench.rig = preloaded(bench.rig, 5e-3);  // cables go slack and taut again
  double least = 1e300, most = 0;
  Hooks watch;
  watch.sides = [](const State& s, Sides& sides) {  // a knock: nearly all of it goes into swinging
    if (s.t >= 0 && s.t < 1e-3) sides.motor.torque -= 50;
  };
  watch.advance = [&](const State& s) {
    if (s.t < 0.06) return;
    const double energy = 0.5 * bench.rig.J_link * s.qd * s.qd +
                          0.5 * bench.rig.J_motor * s.thetad * s.thetad +
                          strain_energy(bench.rig, s.phi);
    least = std::min(least, energy);
    most = std::max(most, energy);
  };
  simulate(bench, {watch}, still(20));
  // The middle of a step of the midpoint rule is off the orbit by (h omega)^2/4 of the oscillating
  // part; omega = sqrt(k/J_motor) up to 700 rad/s, so 8e-5. A drift would show over 20 s, 1500
  // turns.
  CHECK(most / least - 1 < 8e-5);
  CHECK(least > 0.05);
}

TEST_CASE("a link sticks below its friction and breaks away above it") {
  Bench bench;
  for (const double torque : {0.98, 1.02}) {
    const auto q =
        simulate(bench, {push_link(torque * bench.rig.f_s, 0.1, 0.5)}, still(0.5)).exact.q;
    const bool moved = std::any_of(q.begin(), q.end(), [&](double x) { return x != q[0]; });
    CHECK(moved == (torque > 1));
  }
}

TEST_CASE("a command is held exactly from its sample to the next") {
  Bench bench = frictionless();
  bench.kp = 300;
  bench.kd = 1;
  bench.rig.cable_1 = bench.rig.cable_2 = Cable{};  // a free motor
  struct Held {
    double delay, older, old, newest;  // share of each command in a second difference of theta
  };
  for (const Held& held : {Held{0, 0, 0.5, 0.5}, Held{0.5e-3, 0.125, 0.75, 0.125}}) {
    bench.tau_delay = held.delay;
    Run run = moving(2, bench);
    run.load = 0;
    const Signals s = simulate(bench, {}, run).exact;
    double worst = 0;
    for (std::size_t k = 2; k + 1 < s.theta.size(); ++k) {
      const double bend = s.theta[k + 1] - 2 * s.theta[k] + s.theta[k - 1];
      const double tau =
          held.older * s.tau[k - 2] + held.old * s.tau[k - 1] + held.newest * s.tau[k];
      worst = std::max(worst, std::abs(bend - tau * 1e-6 / bench.rig.J_motor));
    }
    CHECK(worst < 1e-13);  // rounding: theta is about 0.1, 40 steps a sample
  }
}

TEST_CASE("half the step, a quarter of the error") {
  Bench bench;
  bench.quantum_theta = 0;  // a count that flips is no matter of the step
  const Run run = moving(4, bench);
  const Signals fine = simulate(bench, {}, run, 640).exact;
  const auto error = [&](int substeps) {
    const Signals s = simulate(bench, {}, run, substeps).exact;
    return std::max(largest_difference(s.q, fine.q), largest_difference(s.theta, fine.theta));
  };
  const double coarse = error(20), used = error(kSubsteps);
  CHECK(used < 0.1 * bench.quantum_q);
  CHECK(used < 0.5 * coarse);  // first order at the ends of sticking, second elsewhere
}

TEST_CASE("the same seed gives the same log, another seed another") {
  const Bench bench;
  Run run = moving(1, bench);
  const Signals first = simulate(bench, {}, run).logged, again = simulate(bench, {}, run).logged;
  CHECK(first.tau == again.tau);
  CHECK(first.q == again.q);
  run.noise = 1;
  CHECK(simulate(bench, {}, run).logged.tau != first.tau);
  CHECK(simulate(bench, {}, run).logged.q == first.q);
}

TEST_CASE("sensors show counts and noise of the stated size") {
  const Bench bench;
  const Recording r = simulate(bench, {}, moving(5, bench));
  CHECK(largest_difference(r.logged.q, r.exact.q) <= bench.quantum_q * 0.5000001);
  CHECK(largest_difference(r.logged.theta, r.exact.theta) <= bench.quantum_theta * 0.5000001);
  double square = 0;
  for (std::size_t k = 0; k < r.exact.tau.size(); ++k)
    square += std::pow(r.logged.tau[k] - r.exact.tau[k], 2);
  // sd of a variance from 5000 normal numbers: sqrt(2/5000) = 2 %; four of them.
  CHECK(std::abs(square / 5000 / std::pow(bench.noise_tau, 2) - 1) < 0.08);
}

#ifdef NDEBUG
TEST_CASE("80 s are simulated in under a second") {
  const Bench bench;
  const std::clock_t start = std::clock();  // of this process: the machine may be busy
  simulate(bench, {}, moving(80, bench));
  CHECK(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC < 1);
}
#endif
