// Rigid drives: position or velocity log, with and without a known load; exact motion in closed
// form, white noise on the torque.
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kInertia = 0.02, kViscous = 0.35, kCoulomb = 0.9, kOffset = 0.12;  // SI
const NamedValues kTruth = {
    {"J", kInertia}, {"f_v", kViscous}, {"f_s", kCoulomb}, {"offset", kOffset}};
const MultiSine kMotion = {{{0.31, 0.6, 0.4}, {1.1, 0.3, 1.9}, {2.7, 0.12, 5.1}, {5.3, 0.05, 3.3}}};

/// 20 s at 1 kHz; `load` is subtracted from the torque the drive has to give.
template <typename Load>
Columns drive_log(bool velocity, double noise, std::uint64_t seed, Load load) {
  Columns log;
  log.columns = {{"t", {}}, {velocity ? "w" : "theta", {}}, {"tau", {}}};
  Normal normal(seed);
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i;
    const double speed = kMotion.at(t, 1);
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(velocity ? speed : kMotion.at(t));
    log.columns[2].second.push_back(kInertia * kMotion.at(t, 2) + kViscous * speed +
                                    kCoulomb * sign(speed) + kOffset - load(kMotion.at(t)) +
                                    noise * normal());
  }
  return log;
}

DynamicPreload fit_rigid(const Bench& bench) {
  DynamicOptions options;
  options.models = {"rigid"};
  return fit_dynamic(bench.logs(), {}, options).preloads.at(0);
}

const auto kNoLoad = [](double) { return 0.0; };

TEST_CASE("a rigid drive is recovered from positions", "[dynamic]") {
  Bench bench;
  bench.add_text(drive_log(false, 0.1, 3000, kNoLoad).csv());
  std::printf("  rigid, theta and tau\n");
  check_recovered(fit_rigid(bench).fits.at(0).parameters, kTruth, 3);
}

TEST_CASE("a rigid drive is recovered from velocities alone", "[dynamic]") {
  Bench bench;
  bench.add_text(drive_log(true, 0.1, 3001, kNoLoad).csv());
  const DynamicPreload preload = fit_rigid(bench);
  std::printf("  rigid, w and tau\n");
  check_recovered(preload.fits.at(0).parameters, kTruth, 3);
  CHECK_FALSE(preload.delay.held);
}

TEST_CASE("a pendulum on a rigid drive is a known load", "[dynamic]") {
  const double mass = 1.3, length = 0.3, zero = 0.2;
  const auto load = [&](double q) { return -mass * kGravity * length * std::sin(q - zero); };
  Bench bench;
  bench.rig.load.law = &find_load_law("pendulum");
  bench.rig.load.parameters.mass = mass;
  bench.rig.load.parameters.length = length;
  bench.rig.load.parameters.zero = zero;
  bench.add_text(drive_log(false, 0.1, 3002, load).csv());
  const DynamicPreload preload = fit_rigid(bench);
  std::printf("  rigid, pendulum\n");
  check_recovered(preload.fits.at(0).parameters, kTruth, 3);
  CHECK_THAT(preload.load_inertia, Catch::WithinRel(mass * length * length, 1e-12));
}

TEST_CASE("forgetting the pendulum is visible", "[dynamic]") {
  const auto load = [](double q) { return -1.3 * kGravity * 0.3 * std::sin(q - 0.2); };
  Bench bench;
  bench.add_text(drive_log(false, 0.1, 3002, load).csv());
  const DynamicFit fit = fit_rigid(bench).fits.at(0);
  // Gravity of 3.8 N m against noise of 0.1: the residual is the load.
  CHECK(fit.torque_error.at("rigid").rms > 0.5);
}

}  // namespace
