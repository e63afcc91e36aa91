// Coarse encoders: quantisation noise in an acceleration shrinks its inertia unless the band of the
// equation is narrowed. Gate of estimation-rules: J biased by at most 1 % above the noise-free
// floor at 16 bit (2 pi / 65536 = 9.6e-5 rad), on whichever side the coarse encoder sits.
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kFine = 6e-6, k16Bit = 9.6e-5;  // rad

std::vector<Estimate> fit(double quantum_q, double quantum_theta) {
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  ElasticResult stage1 = fit_elastic(blocked, {});
  stage1.preloads.at(0).name = "default";
  Bench bench;
  std::uint64_t seed = 7000;
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions options;
    options.seed = seed++;
    options.duration = 8;
    options.load = load;
    options.quantum_q = quantum_q;
    options.quantum_theta = quantum_theta;
    bench.add(truth::simulate_moving(truth::Rig::low(), options));
  }
  return fit_dynamic(bench.logs(), stage1, {}).preloads.at(0).fits.at(0).parameters;
}

void check_inertias(double quantum_q, double quantum_theta) {
  const std::vector<Estimate> found = fit(quantum_q, quantum_theta);
  const truth::Rig rig = truth::Rig::low();
  for (const auto& [name, truth] : NamedValues{{"J_link", rig.J_link}, {"J_motor", rig.J_motor}}) {
    const Estimate& e = estimate(found, name);
    std::printf("  quantum of q %.1e, of theta %.1e: %-7s %+.2f %% +- %.2f %%\n", quantum_q,
                quantum_theta, name.c_str(), 100 * (e.value / truth - 1), 100 * e.sd / truth);
    INFO(name);
    // 1 %, and three sd of the estimate's own scatter.
    CHECK(std::abs(e.value - truth) < 0.01 * truth + 3 * e.sd);
    CHECK(std::abs(e.value - truth) < 0.02 * truth);
  }
}

TEST_CASE("inertias with fine encoders", "[recover]") { check_inertias(kFine, kFine); }
TEST_CASE("inertias with a 16-bit motor encoder", "[recover]") { check_inertias(kFine, k16Bit); }
TEST_CASE("inertias with a 16-bit link encoder", "[recover]") { check_inertias(k16Bit, kFine); }
TEST_CASE("inertias with two 16-bit encoders", "[recover]") { check_inertias(k16Bit, k16Bit); }

}  // namespace
