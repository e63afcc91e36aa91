// Models on the shipped logs. The parameters these were made with are known (data/README.md), so a
// gap is the sensors', the torque noise's or a mistake of ours.
#include "cablefit/simulate/replay.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "tests/simulate/true_models.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kQuantumQ = 6e-6, kQuantumTheta = 2.4e-5;  // rad
constexpr double kTorqueNoise = 0.3;                        // N m
constexpr const char* kMovingLogs[] = {"moving_load30.csv", "moving_load-40.csv"};

void print(const SimulatedPart& part) {
  std::printf("    %s, %s:", part.log.c_str(), std::string(part.mode()).c_str());
  for (const SignalGap& gap : part.gaps) std::printf(" %s %.3g", gap.signal.c_str(), gap.rms);
  std::printf("\n");
}

TEST_CASE("the true model in closed loop meets the logs to within the encoders", "[simulate]") {
  // Rounding alone leaves 0.29 quantum. On top of it the controller, which sees rounded positions,
  // now and then sees one count more or less than it did on the bench: kd quantum / period = 0.14
  // N m for one period, after which theta is off by up to 0.14 T^2 / J_motor = 0.4 quantum.
  for (const std::string preload : {"low", "high"}) {
    for (const char* log : kMovingLogs) {
      const SimulatedPart part = simulate_shipped(true_model(preload), preload + "/" + log);
      print(part);
      CHECK(part.closed_loop);
      CHECK(part.n_rows == 16000);
      CHECK(part.n_windows == 1);
      CHECK(gap_of(part, "theta").rms < 0.5 * kQuantumTheta);
      CHECK(gap_of(part, "theta").max_abs < 2 * kQuantumTheta);
      CHECK(gap_of(part, "q").rms < kQuantumQ);
      CHECK(gap_of(part, "deflection").rms < 0.5 * kQuantumTheta);
      // The record's noise, and 0.14 N m wherever a count differs.
      CHECK(gap_of(part, "tau").rms < 1.1 * kTorqueNoise);
      CHECK(gap_of(part, "tau").noise == kTorqueNoise);
    }
  }
}

TEST_CASE("rounding is all that is left in closed loop", "[simulate]") {
  // A log without any, but for the file's: six decimals, which leave 2.9e-7 rad. The bench itself
  // is simulated 20 times finer than the shipped logs, its steps being of first order at stops.
  truth::MovingOptions options;
  options.duration = 3;
  options.load = 30;
  options.quantum_q = options.quantum_theta = options.noise_tau = 0;
  options.fine_rate = 8e5;
  const TempFolder folder;
  truth::write_csv(folder.file("log.csv"), truth::simulate_moving(truth::Rig::low(), options));
  folder.write("rig.json", R"({"load": {"type": "column"},
                               "controller": {"kp": 800, "kd": 6, "limit": 250}})");
  const Model model = true_model("low");
  const std::vector<LogSurvey> logs = {survey_for_simulation(folder.file("log.csv"), "", model)};
  const SimulatedPart part = simulate_logs(model, logs, {}).parts.at(0);
  print(part);
  CHECK(gap_of(part, "q").rms < 1.5 * 2.9e-7);
  CHECK(gap_of(part, "theta").rms < 1.5 * 2.9e-7);
  CHECK(gap_of(part, "tau").rms < 5e-3);  // the file's 1e-3 N m, and kd times what theta is off
}

TEST_CASE("a replayed torque drifts by its own noise", "[simulate]") {
  // Both axes together move freely against f = f_v + f_vm: noise of sd s, held over T, gives a
  // velocity noise of s / f per period, a position of sd s / f sqrt(T t) after t, and over windows
  // of length W an rms of s / f sqrt(T W / 2). Sixteen windows: their rms is known to about 30 %;
  // friction that stops an axis takes away from it.
  for (const std::string preload : {"low", "high"}) {
    const truth::Rig rig = preload == "low" ? truth::Rig::low() : truth::Rig::high();
    const double drift = kTorqueNoise / (rig.f_v + rig.f_vm) * std::sqrt(1e-3 * 1.0 / 2);
    for (const char* log : kMovingLogs) {
      const SimulatedPart part =
          simulate_shipped(true_model(preload), preload + "/" + log, in_mode(ReplayMode::torque));
      print(part);
      CHECK_FALSE(part.closed_loop);
      CHECK(part.held_torque);
      CHECK(part.n_windows == 16);
      CHECK(part.n_rows == 16000);
      CHECK(gap_of(part, "theta").rms < 1.5 * drift);
      CHECK(gap_of(part, "theta").rms > 0.3 * drift);
      CHECK(gap_of(part, "theta").worst_window_rms > gap_of(part, "theta").rms);
      // The deflection does not drift: it answers to 0.3 N m of noise about as a spring of 3 kN m.
      CHECK(gap_of(part, "deflection").rms < 1.3e-4);
    }
  }
}

TEST_CASE("windows: shorter ones drift less, and they may straddle blocks", "[simulate]") {
  ReplayOptions options = in_mode(ReplayMode::torque);
  double last = 0;
  const std::vector<std::pair<double, std::size_t>> windows = {{0.1, 160}, {1, 16}, {9, 2}, {0, 1}};
  for (const auto& [seconds, n_windows] : windows) {
    options.window = seconds;
    const SimulatedPart part =
        simulate_shipped(true_model("low"), "low/moving_load30.csv", options);
    INFO("windows of " << seconds << " s");
    CHECK(part.n_windows == n_windows);
    CHECK(part.n_rows == 16000);
    CHECK(gap_of(part, "theta").rms > last);
    last = gap_of(part, "theta").rms;
  }
}

TEST_CASE("blocked logs replay with the link held", "[simulate]") {
  for (const std::string preload : {"low", "high"}) {
    const SimulatedPart part = simulate_shipped(true_model(preload), preload + "/blocked.csv");
    print(part);
    CHECK(part.phase == "blocked");
    CHECK_FALSE(part.closed_loop);
    CHECK(part.n_windows == 40);
    CHECK(part.n_rows == 20000);
    CHECK(gap_of(part, "q").max_abs == 0);
    // 0.3 N m of torque noise over the spring of 1.4 to 3.6 kN m/rad: 0.1 to 0.2 mrad.
    CHECK(gap_of(part, "theta").rms < 2e-4);
  }
}

TEST_CASE("without preload one cable is slack at any time, with it both are taut", "[simulate]") {
  const SimulatedPart low = simulate_shipped(true_model("low"), "low/moving_load30.csv");
  CHECK(low.closure_share == 0.0);
  REQUIRE(low.cables.size() == 2);
  CHECK(low.cables[0].min == 0);
  CHECK(low.cables[1].min == 0);
  CHECK(low.cables[0].slack_share + low.cables[1].slack_share >= 1);
  const SimulatedPart high = simulate_shipped(true_model("high"), "high/moving_load30.csv");
  CHECK(high.closure_share.value() > 0.1);  // +30 N m of load: cable 1 is slack most of the time
  CHECK(high.closure_share.value() < 0.3);
  CHECK(high.cables[0].slack_share == Approx(1 - *high.closure_share).margin(2e-3));
}

TEST_CASE("results do not depend on threads, and come in the order of the logs", "[simulate]") {
  const Model model = true_model("low");
  std::vector<LogSurvey> logs;
  for (const char* log : {"low/moving_load30.csv", "low/blocked.csv", "low/moving_load-40.csv"}) {
    logs.push_back(shipped_for(model, log));
  }
  ReplayOptions options;
  const SimulateResult one = simulate_logs(model, logs, options);
  options.threads = 3;
  const SimulateResult three = simulate_logs(model, logs, options);
  REQUIRE(three.parts.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(three.parts[k].log == logs[k].plan.path);
    for (std::size_t i = 0; i < one.parts[k].gaps.size(); ++i) {
      CHECK(three.parts[k].gaps[i].rms == one.parts[k].gaps[i].rms);
    }
  }
}

TEST_CASE("only the wanted end of a part is compared", "[simulate]") {
  // A friction that is wrong shows in both halves; the first of which is simulated all the same.
  Model model = true_model("low");
  model.joints.front().link.at(1).parameters.at(0).value *= 2;
  ReplayOptions options;
  const SimulatedPart all = simulate_shipped(model, "low/moving_load30.csv", options);
  options.compared = 0.5;
  const SimulatedPart end = simulate_shipped(model, "low/moving_load30.csv", options);
  options.compared = 1e-9;
  const SimulatedPart last = simulate_shipped(model, "low/moving_load30.csv", options);
  const double length = static_cast<double>(all.n_rows) * 1e-3;
  CHECK(end.n_rows == all.n_rows);
  CHECK(gap_of(end, "deflection").t_of_max >= 0.5 * (length - 1e-3));
  CHECK(gap_of(end, "deflection").max_abs <= gap_of(all, "deflection").max_abs);
  CHECK(gap_of(end, "deflection").rms > 0);
  CHECK(gap_of(last, "deflection").t_of_max == Approx(length - 1e-3));  // one row
  CHECK(gap_of(last, "deflection").max_abs > 0);
  CHECK(gap_of(last, "deflection").rms == Approx(gap_of(last, "deflection").max_abs));
}

}  // namespace
