// What is no row of the catalogue is described: frequency, damping, correlation time.
#include <catch2/catch.hpp>

#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/rows/residual_spectrum.hpp"
#include "cablefit/refine/verdict/regimes.hpp"
#include "cablefit/refine/verdict/unexplained.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

BaseFit base_of(const HiddenLogs& hidden) {
  std::vector<LogSurvey> logs = hidden.logs.blocked;
  logs.insert(logs.end(), hidden.logs.train.begin(), hidden.logs.train.end());
  return fit_base(
      make_design(hidden.models,
                  read_stretches(logs, hidden.models, [](const PartSurvey&) { return true; }),
                  smoothing_for(1e-3)),
      2, nullptr);
}

/// The floor of the same seed without an effect.
const KindLevels& floor() {
  static const KindLevels kFloor = base_of(hidden_logs({})).fit.rms();
  return kFloor;
}

std::optional<Unexplained> described(const HiddenLogs& hidden) {
  const BaseFit base = base_of(hidden);
  return describe_remainder(base.design, base.fit.x, floor(), 2);
}

}  // namespace

TEST_CASE("an unmodelled mode has its frequency, damping and inertia", "[refine][unexplained]") {
  const auto found = described(hidden_logs({"attached_mode.link=1"}));
  REQUIRE(found);
  CHECK(found->kind == "mode");
  CHECK(found->equation == "link");
  CHECK(found->frequency == Approx(9).epsilon(0.02));
  CHECK(found->damping == Approx(0.03).epsilon(0.3));
  CHECK(found->inertia == Approx(0.02).epsilon(0.1));
  CHECK(found->share_of_squared_gap > 0.9);
}

TEST_CASE("a hum has its frequency and no damping", "[refine][unexplained]") {
  const auto found = described(hidden_logs({"hum.motor=1"}));
  REQUIRE(found);
  CHECK(found->kind == "hum");
  CHECK(found->equation == "motor");
  // Runs of 6 s: a line is 1/6 Hz wide, its middle known much better.
  CHECK(found->frequency == Approx(7.3).margin(0.05));
  CHECK(found->damping == 0);
}

TEST_CASE("what wanders has a correlation time", "[refine][unexplained]") {
  const auto found = described(hidden_logs({}, 1, "short", 0.1));
  REQUIRE(found);
  CHECK(found->kind == "wandering");
  CHECK(found->equation == "link");
  // 0.3 s by the simulator, estimated over 24 s of which the fit takes the slowest part.
  CHECK(found->correlation_time > 0.1);
  CHECK(found->correlation_time < 0.5);
  CHECK(found->rms == Approx(0.1).epsilon(0.3));
}

TEST_CASE("nothing is described at the noise floor", "[refine][unexplained]") {
  CHECK_FALSE(described(hidden_logs({})));  // exactly there: any gap above it is described
}

TEST_CASE("a line stands out of the floor by its frequency", "[refine][unexplained]") {
  const BaseFit quiet = base_of(hidden_logs({})), loud = base_of(hidden_logs({"hum.motor=1"}));
  const auto bands = find_bands(loud.design, loud.fit.x, quiet.design, quiet.fit.x);
  REQUIRE_FALSE(bands.empty());
  CHECK(bands.front().equation == "motor");
  CHECK(bands.front().regime == "frequency");
  CHECK(bands.front().from < 7.3);
  CHECK(bands.front().to > 7.3);
  CHECK(bands.front().to - bands.front().from < 8);
  CHECK(bands.front().share_of_squared_gap > 0.7);
  const BaseFit other = base_of(hidden_logs({}, 2));
  CHECK(find_bands(other.design, other.fit.x, quiet.design, quiet.fit.x).empty());
}

/// The bands of a spectrum add up to the variance, and a line is where it is.
TEST_CASE("a spectrum adds up to the variance", "[refine][unexplained]") {
  ResidualMemory memory;
  memory.period = 0.01;
  memory.n_values = 1000;
  memory.covariance.resize(64);
  for (Eigen::Index lag = 0; lag < 64; ++lag)
    memory.covariance(lag) =
        0.5 * std::cos(2 * 3.14159265358979 * 12.3 * 0.01 * static_cast<double>(lag));
  const Spectrum spectrum = spectrum_of(memory, 50);
  CHECK(spectrum.width == Approx(1));
  Eigen::Index peak = 0;
  spectrum.power.maxCoeff(&peak);
  CHECK(std::abs(spectrum.middle(peak) - 12.3) < 1);
  // A Hann window has no negative lobe beyond some per cent.
  CHECK(spectrum.power.sum() == Approx(0.5).epsilon(0.05));
}
