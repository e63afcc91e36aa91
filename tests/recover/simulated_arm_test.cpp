// A finger simulated by the library with known numbers, and fitted to logs of that: its base
// parameters and frictions come back.
#include "tests/recover/joints_truth.hpp"
#include "tests/simulate/arm_models.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {
namespace {

constexpr double kSimulatedLimit = 3;  // sd
constexpr double kSimulatedRate = 1000;

/// A log of the simulated positions, rounded as by encoders, with noise of the torque.
std::string simulated_log(const PlainRig& plain, const SimulationResult& result, unsigned seed) {
  PlainLog log(plain, seed);
  for (Eigen::Index i = 0; i < result.q.rows(); ++i) {
    const auto row = [&](const Eigen::ArrayXXd& table) {
      return std::vector<double>{table(i, 0), table(i, 1)};
    };
    log.add(static_cast<double>(i) / kSimulatedRate, row(result.q), row(result.theta),
            row(result.tau), {0, 0});
  }
  return log.text();
}

TEST_CASE("a simulated finger gives back its base parameters", "[recover]") {
  const PlainRig plain = phalanges_rig();
  const Model truth = arm_model(plain, phalanges(), pd_text(6, 0.06));
  const Eigen::Index n_rows = 20000;
  SimulationInput input = quiet_input(n_rows, 1 / kSimulatedRate, 2);
  input.theta_ref = swinging(n_rows, 1 / kSimulatedRate, 2, 0.45);
  SimulationOptions closed;
  closed.closed_loop = true;
  const SimulationResult motion = simulate(truth, input, closed);
  REQUIRE_FALSE(motion.diverged_at);

  Bench bench;
  bench.rig = truth.rig;
  const std::vector<double> at(plain.n(), 10000 * plain.quantum);
  bench.add_text(blocked_log(plain, at, 100, 51));
  bench.add_text(simulated_log(plain, motion, 52));
  const ElasticResult elastic = fit_elastic(bench.logs(), {});
  DynamicOptions options;
  options.models = {"poly"};
  const DynamicResult dynamic = fit_dynamic(bench.logs(), elastic, options);
  const DynamicFit& fit = dynamic.preloads.at(0).fits.at(0);
  NamedValues values;
  for (const Estimate& e : truth.arm) values.emplace_back(e.name, e.value);
  for (const auto& value : stage2_truth(plain)) values.push_back(value);
  check_recovered(fit.parameters, values, kSimulatedLimit);
}

}  // namespace
}  // namespace cablefit::test
