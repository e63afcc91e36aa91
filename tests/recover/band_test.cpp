// The 95 % band of a simulation against the true motion, over seeds: a model is fitted to noisy
// logs, and simulated beside a motion that it has not seen, recorded without noise.
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/simulate/replay.hpp"
#include "tests/support/monte_carlo.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Both stages on logs of these seeds, as a model file has them.
Model fitted_model(std::uint64_t& seed, const TempFolder& folder) {
  truth::BlockedOptions blocked;
  blocked.seed = seed++;
  Bench stage1;
  stage1.add(truth::simulate_blocked(truth::Rig::low(), blocked));
  const ElasticResult elastic = fit_elastic_stage(stage1.logs(), {}, ElongationMode::automatic);
  Bench stage2;
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions moving;
    moving.seed = seed++;
    moving.duration = 8;
    moving.load = load;
    stage2.add(truth::simulate_moving(truth::Rig::low(), moving));
  }
  const std::string file =
      folder.write("dynamic.json", dynamic_json(fit_dynamic(stage2.logs(), elastic, {})));
  std::string choice;
  return read_model(file, "", "poly", choice);
}

/// A motion under another load, without noise and rounding; its folder has the controller.
std::string perfect_log(const TempFolder& folder) {
  truth::MovingOptions options;
  options.duration = 6;
  options.load = 15;
  options.seed = 7;
  options.quantum_q = options.quantum_theta = options.noise_tau = 0;
  options.fine_rate = 2e5;
  truth::write_csv(folder.file("log.csv"), truth::simulate_moving(truth::Rig::low(), options));
  folder.write("rig.json", R"({"load": {"type": "column"}, "torque_hold": "zoh",
                               "controller": {"kp": 800, "kd": 6, "limit": 250}})");
  return folder.file("log.csv");
}

/// Of one signal, over all runs.
struct BandTable {
  double n = 0, inside = 0, squared_gap = 0, squared_sd = 0;
  void add(const SignalGap& gap) {
    n += 1;
    inside += gap.band->inside;
    squared_gap += gap.rms * gap.rms;
    squared_sd += std::pow(gap.band->half_width / kNormal975, 2);
  }
};

TEST_CASE("a band of the parameters holds the true motion", "[recover][monte-carlo]") {
  const int n_runs = full_monte_carlo() ? 100 : 12;
  const TempFolder folder;
  const std::string log = perfect_log(folder);
  std::map<std::string, BandTable> tables;
  std::uint64_t seed = 5000;
  for (int run = 0; run < n_runs; ++run) {
    const Model model = fitted_model(seed, folder);
    REQUIRE_FALSE(model.covariance.empty());
    ReplayOptions options;
    options.band = true;
    const std::vector<LogSurvey> logs = {survey_for_simulation(log, "", model)};
    const SimulatedPart part = simulate_logs(model, logs, options).parts.at(0);
    for (const SignalGap& gap : part.gaps) {
      REQUIRE(gap.band);
      tables[gap.signal].add(gap);
    }
  }
  std::printf("95 %% bands of a simulation, %d fits, low preload\n", n_runs);
  double inside = 0;
  for (const auto& [signal, t] : tables) {
    const double ratio = std::sqrt(t.squared_gap / t.squared_sd);
    std::printf("    %-10s inside %5.1f %%, rms gap / rms sd %.2f\n", signal.c_str(),
                100 * t.inside / t.n, ratio);
    inside += t.inside / t.n / static_cast<double>(tables.size());
    // A run's gap follows about three independent errors of the parameters: of n runs the ratio has
    // an sd of 1 / sqrt(6 n), 12 % of 12 runs.
    CHECK(std::abs(ratio - 1) < 3 / std::sqrt(6.0 * n_runs) + 0.1);
  }
  std::printf("    all signals: %.1f %%\n", 100 * inside);
  // 95 % are expected, the rows of a run being right or wrong together: with three independent
  // errors a run, the share has an sd of sqrt(0.95 0.05 / (3 n)).
  CHECK(inside > 0.95 - 3 * std::sqrt(0.95 * 0.05 / (3.0 * n_runs)));
}

}  // namespace
