// A commanded torque acts half a period late on average; one that ignores it gets J_motor wrong,
// and a log without a hold must not be shifted.
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

ElasticResult stage1_of(const truth::Rig& rig) {
  truth::BlockedOptions options;
  options.seed = 2000;
  Bench bench;
  bench.add(truth::simulate_blocked(rig, options));
  return fit_elastic(bench.logs(), {});
}

/// Two moving logs. `centred`: the torque is the mean over (t - T/2, t + T/2), as an averaging
/// current sensor records it, instead of the command at t.
Bench moving_logs(bool centred) {
  Bench bench;
  std::uint64_t seed = 2001;
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions options;
    options.seed = seed++;
    options.duration = 8;
    options.load = load;
    truth::Truth exact;
    truth::Log log = truth::simulate_moving(truth::Rig::low(), options, &exact);
    Normal noise(seed);
    if (centred)
      for (std::size_t i = 1; i < log.tau.size(); ++i)
        log.tau[i] = 0.5 * (exact.tau[i - 1] + exact.tau[i]) + options.noise_tau * noise();
    bench.add(log);
  }
  return bench;
}

DynamicPreload fit(const Bench& bench, const ElasticResult& stage1, TorqueHold hold,
                   double cutoff = 0) {
  DynamicOptions options;
  options.samples.torque_hold = hold;
  if (cutoff > 0) options.samples.cutoff = cutoff;
  return fit_dynamic(bench.logs(), stage1, options).preloads.at(0);
}

/// Relative error of a parameter.
double error_of(const DynamicPreload& preload, const std::string& name, double truth) {
  return estimate(preload.fits.at(0).parameters, name).value / truth - 1;
}
double inertia_error(const DynamicPreload& preload) {
  return error_of(preload, "J_motor", truth::Rig::low().J_motor);
}
double damping_error(const DynamicPreload& preload) {
  return error_of(preload, "f_vm", truth::Rig::low().f_vm);
}

// To first order an ignored delay d adds d dtau/dt to the torque: d f_vm = 4 % of J_motor to
// J_motor, and d K = 1.2 N m s/rad, more than all of f_vm, to what multiplies the speed of the
// deflection. The higher the band, the more of that the fit can tell from inertia: J_motor shows it
// at 50 Hz (8 %), f_vm at any band (27 %).
TEST_CASE("a held torque is found, and ignoring it spoils J_motor", "[dynamic]") {
  const ElasticResult stage1 = stage1_of(truth::Rig::low());
  const Bench bench = moving_logs(false);
  const DynamicPreload found = fit(bench, stage1, TorqueHold::automatic);
  const DynamicPreload ignored = fit(bench, stage1, TorqueHold::none);
  const double at_50 = inertia_error(fit(bench, stage1, TorqueHold::zoh, 50));
  const double ignored_at_50 = inertia_error(fit(bench, stage1, TorqueHold::none, 50));
  std::printf("  held log: delay %.4f +- %.4f ms\n", 1e3 * found.delay.seconds,
              1e3 * found.delay.sd);
  std::printf("    J_motor %+.2f %% with the hold, %+.2f %% without; at 50 Hz %+.2f, %+.2f %%\n",
              100 * inertia_error(found), 100 * inertia_error(ignored), 100 * at_50,
              100 * ignored_at_50);
  std::printf("    f_vm %+.2f %% with the hold, %+.2f %% without\n", 100 * damping_error(found),
              100 * damping_error(ignored));
  CHECK(found.delay.held);
  // Half a period; 4 sd, and 2 % of the period for what the first-order expansion leaves.
  CHECK(std::abs(found.delay.seconds - 0.5e-3) < 4 * found.delay.sd + 0.02e-3);
  CHECK(std::abs(inertia_error(found)) < 0.01);
  CHECK(std::abs(at_50) < 0.01);
  CHECK(std::abs(ignored_at_50) > 0.04);
  CHECK(std::abs(damping_error(found)) < 0.02);
  CHECK(std::abs(damping_error(ignored)) > 0.15);
}

// The mean over (t - T/2, t + T/2) of a held torque is (tau[i-1] + tau[i])/2 and needs no further
// averaging; cablefit takes an unheld torque for a continuous one and averages it like the rest.
// That costs J_motor K T^2/(12 J_motor) = 1.6 % here (K 2600 N m/rad): 2 % is allowed.
TEST_CASE("a torque that is the mean centred on t is not shifted", "[dynamic]") {
  const ElasticResult stage1 = stage1_of(truth::Rig::low());
  const Bench bench = moving_logs(true);
  const DynamicPreload found = fit(bench, stage1, TorqueHold::automatic);
  const DynamicPreload shifted = fit(bench, stage1, TorqueHold::zoh);
  std::printf("  centred log: delay %.4f +- %.4f ms\n", 1e3 * found.delay.seconds,
              1e3 * found.delay.sd);
  std::printf("    J_motor %+.2f %% as it is, %+.2f %% shifted; f_vm %+.2f %%, %+.2f %%\n",
              100 * inertia_error(found), 100 * inertia_error(shifted), 100 * damping_error(found),
              100 * damping_error(shifted));
  CHECK_FALSE(found.delay.held);
  CHECK(std::abs(found.delay.seconds) < 4 * found.delay.sd + 0.02e-3);
  CHECK(std::abs(inertia_error(found)) < 0.02);
  CHECK(std::abs(damping_error(found)) < 0.02);
  CHECK(std::abs(damping_error(shifted)) > 0.15);
}

/// Every `n`th row of a log: the drive holds each torque for that part of the log's period.
Bench every(std::size_t n, std::size_t late = 0) {
  Bench bench;
  truth::MovingOptions options;
  options.seed = 2001;
  options.duration = 20;
  options.load = 30;
  truth::Log log = truth::simulate_moving(truth::Rig::low(), options);
  log.tau.erase(log.tau.begin(), log.tau.begin() + static_cast<std::ptrdiff_t>(late));
  for (auto* column : {&log.t, &log.q, &log.theta, &log.tau_load, &log.theta_ref})
    column->resize(log.tau.size());
  for (auto* column : {&log.t, &log.q, &log.theta, &log.tau, &log.tau_load, &log.theta_ref}) {
    const std::size_t kept = column->size() / n;
    for (std::size_t i = 0; i < kept; ++i) (*column)[i] = (*column)[n * i];
    column->resize(kept);
  }
  bench.add(log);
  return bench;
}

TEST_CASE("a hold of a part of the log's row is found and used", "[dynamic]") {
  const ElasticResult stage1 = stage1_of(truth::Rig::low());
  for (const std::size_t n : {2, 4}) {
    const Bench bench = every(n);
    const DynamicPreload found = fit(bench, stage1, TorqueHold::automatic);
    const DynamicPreload given = fit(bench, stage1, TorqueHold::zoh);
    INFO(found.delay.reason);
    CHECK(found.delay.held);
    CHECK(found.delay.period == Approx(1e-3));
    CHECK(found.delay.warning.empty());
    CHECK(given.delay.warning.starts_with("torque hold zoh was given, but the torque acts"));
    std::printf("  every %zu. row: J_motor %+.2f %%, f_vm %+.2f %%; by the row %+.2f, %+.2f %%\n",
                n, 100 * inertia_error(found), 100 * damping_error(found),
                100 * inertia_error(given), 100 * damping_error(given));
    // d K = 0.5 ms 2600 N m/rad is more than all of f_vm. At 250 Hz, a tenth is the error of
    // differences of a motion of 45 Hz.
    CHECK(std::abs(damping_error(found)) < (n == 2 ? 0.02 : 0.12));
    CHECK(std::abs(damping_error(given)) > 0.3);
  }
}

TEST_CASE("a torque that no hold explains is warned about", "[dynamic]") {
  const DynamicPreload found =
      fit(every(1, 1), stage1_of(truth::Rig::low()), TorqueHold::automatic);
  INFO(found.delay.reason);
  CHECK(std::abs(found.delay.seconds - 1.5e-3) < 0.2e-3);
  CHECK(found.delay.warning.find("neither a hold of 1 ms nor none explains that") !=
        std::string::npos);
  CHECK(found.delay.warning.find("\"torque_period\"") != std::string::npos);
}

}  // namespace
