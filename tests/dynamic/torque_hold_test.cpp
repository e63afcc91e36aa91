// A commanded torque acts half a period late on average; one that ignores it gets J_motor wrong,
// and a log without a hold must not be shifted.
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

ElasticResult exact_stage1(const truth::Rig& rig) {
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

DynamicPreload fit(const Bench& bench, const ElasticResult& stage1, TorqueHold hold) {
  DynamicOptions options;
  options.samples.torque_hold = hold;
  return fit_dynamic(bench.logs(), stage1, options).preloads.at(0);
}

double motor_inertia_error(const DynamicPreload& preload) {
  const Estimate& e = estimate(preload.fits.at(0).parameters, "J_motor");
  return e.value / truth::Rig::low().J_motor - 1;
}

TEST_CASE("a held torque is found, and ignoring it spoils J_motor", "[dynamic]") {
  const ElasticResult stage1 = exact_stage1(truth::Rig::low());
  const Bench bench = moving_logs(false);
  const DynamicPreload found = fit(bench, stage1, TorqueHold::automatic);
  const DynamicPreload ignored = fit(bench, stage1, TorqueHold::none);
  std::printf("  held log: delay %.4f +- %.4f ms, J_motor %+.2f %% with the hold, %+.2f %% without\n",
              1e3 * found.delay.seconds, 1e3 * found.delay.sd, 100 * motor_inertia_error(found),
              100 * motor_inertia_error(ignored));
  CHECK(found.delay.held);
  // Half a period; 4 sd, and 2 % of the period for what the first-order expansion leaves.
  CHECK(std::abs(found.delay.seconds - 0.5e-3) < 4 * found.delay.sd + 0.02e-3);
  CHECK(std::abs(motor_inertia_error(found)) < 0.01);
  CHECK(std::abs(motor_inertia_error(ignored)) > 0.04);
}

TEST_CASE("a torque that is the mean centred on t is not shifted", "[dynamic]") {
  const ElasticResult stage1 = exact_stage1(truth::Rig::low());
  const Bench bench = moving_logs(true);
  const DynamicPreload found = fit(bench, stage1, TorqueHold::automatic);
  const DynamicPreload shifted = fit(bench, stage1, TorqueHold::zoh);
  std::printf(
      "  centred log: delay %.4f +- %.4f ms, J_motor %+.2f %% as it is, %+.2f %% shifted\n",
      1e3 * found.delay.seconds, 1e3 * found.delay.sd, 100 * motor_inertia_error(found),
      100 * motor_inertia_error(shifted));
  CHECK_FALSE(found.delay.held);
  CHECK(std::abs(found.delay.seconds) < 4 * found.delay.sd + 0.02e-3);
  CHECK(std::abs(motor_inertia_error(found)) < 0.01);
  CHECK(std::abs(motor_inertia_error(shifted)) > 0.04);
}

}  // namespace
