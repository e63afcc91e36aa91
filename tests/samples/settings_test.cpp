// Filter, decimation, edges and rest: chosen from the log with a reason, or given.
#include "cablefit/samples/rows/settings.hpp"
#include "cablefit/samples/survey/noise.hpp"

#include "tests/samples/rows_of_logs.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

const Decision& decision(const ChosenSettings& chosen, const std::string& name) {
  for (const Decision& d : chosen.decisions)
    if (d.name == name) return d;
  FAIL("no decision about " << name);
  return chosen.decisions.front();
}

// The shipped low log: 1 kHz, encoder of 2.4e-5 rad, 220 rad/s^2. Noise leaves the band alone:
// 2.4e-5/sqrt(12) below 200 Hz is 3 rad/s^2 of acceleration, 0.02 % of the variance.
TEST_CASE("settings of a moving log follow the resonance", "[samples]") {
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv")};
  const ChosenSettings chosen = moving_settings(logs, kAllParts, {}, 76);
  CHECK_THAT(chosen.rows.signal.cutoff, Catch::WithinRel(2.5 * 76, 1e-12));
  CHECK(decision(chosen, "cut-off").value == "190 Hz");
  CHECK(decision(chosen, "cut-off").reason == "2.5 times the free resonance under load, 76 Hz");
  CHECK(chosen.rows.decimate == 2);    // 1000 / (2.5 * 190) = 2.1
  CHECK(chosen.rows.drop_edge == 11);  // 2 * 1000 / 190 = 10.5
  CHECK(decision(chosen, "edge rows").reason == "two periods of the cut-off");
  CHECK(chosen.rows.signal.filter_order == 4);
  CHECK(chosen.rows.rest_margin == 6);  // 1000 / 190 = 5.3: one period of the cut-off
  CHECK(decision(chosen, "rest margin").value == "0.006 s");
  CHECK(chosen.rest_speed_theta > 0);
  CHECK(chosen.rest_speed_q > 0);
  CHECK(chosen.warnings.empty());
  // A resonance beyond what the rate carries: 0.2 of the rate. What that does to J_motor is known
  // after the fit.
  const ChosenSettings high = moving_settings(logs, kAllParts, {}, 150);
  CHECK_THAT(high.rows.signal.cutoff, Catch::WithinRel(200, 1e-12));
  CHECK(decision(high, "cut-off").reason == "0.2 of the sample rate");
  CHECK(high.warnings.empty());
  CHECK(high.resonance == 150);
}

TEST_CASE("options win and are told as given", "[samples]") {
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv")};
  SampleOptions options;
  options.cutoff = 33;
  options.filter_order = 2;
  options.decimate = 7;
  options.drop_edge = 123;
  options.rest_speed = 0.25;
  const ChosenSettings chosen = moving_settings(logs, kAllParts, options, 0);
  CHECK(chosen.rows.signal.cutoff == 33);
  CHECK(chosen.rows.signal.filter_order == 2);
  CHECK(chosen.rows.decimate == 7);
  CHECK(chosen.rows.drop_edge == 123);
  CHECK(chosen.rest_speed_theta == 0.25);
  CHECK(chosen.rest_speed_q == 0.25);
  for (const Decision& d : chosen.decisions) {
    INFO(d.name);
    if (d.name != "rest margin") CHECK(d.reason == "given");  // follows from the cut-off
  }
  options.cutoff = 0;
  options.rest_speed = 0;
  const ChosenSettings raw = moving_settings(logs, kAllParts, options, 0);
  CHECK(raw.rows.signal.cutoff == 0);
  CHECK(raw.rows.rest_margin == 0);
  CHECK(decision(raw, "cut-off").value == "none");
}

TEST_CASE("a cut-off the rate does not carry is a usage error", "[samples]") {
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv")};
  SampleOptions options;
  options.cutoff = 450;
  CHECK(message_of([&] { moving_settings(logs, kAllParts, options, 0); }) ==
        "--cutoff 450 is not below 0.45 of the sample rate of 1000 Hz; choose a lower cut-off, or "
        "0 for no filter");
}

// 16-bit encoder: a noisy acceleration shrinks its coefficient, so the band narrows until noise is
// below 0.25 % of the acceleration's variance, whatever the wish.
TEST_CASE("position noise lowers the cut-off", "[samples]") {
  Columns log = noisy_log(8000, 5300);
  for (double& theta : log.columns[1].second) theta = 1e-4 * std::round(theta / 1e-4);
  Bench bench;
  bench.add_text(log.csv());
  const ChosenSettings chosen = moving_settings(bench.logs(), kAllParts, {}, 0);
  const double cutoff = chosen.rows.signal.cutoff;
  CHECK(cutoff < 100);  // the wish: a tenth of the rate
  CHECK(decision(chosen, "cut-off").reason ==
        "position noise below 0.25 % of the acceleration's variance");
  // rms of the true acceleration: sum of lines, amplitude * omega^2 / sqrt(2).
  const double rms =
      std::sqrt(0.5 * (std::pow(0.5 * std::pow(4.4, 2), 2) + std::pow(0.08 * std::pow(19.5, 2), 2) +
                       std::pow(0.01 * std::pow(56.5, 2), 2)));
  const double noise = acceleration_noise(1e-4 / std::sqrt(12.0), cutoff, 1000);
  std::printf("  16-bit encoder: cut-off %.1f Hz, noise %.2f of %.1f rad/s^2\n", cutoff, noise,
              rms);
  // One step of 0.8 in the cut-off is 0.8^2.5 = 0.57 in the noise; the quantum's noise estimate
  // may be 30 % above 1/sqrt(12) with white noise of 1e-5 in it.
  CHECK(noise <= 0.05 * rms * 1.02);
  CHECK(noise > 0.05 * rms * 0.57 / 1.3);
}

// Monte Carlo of the closed forms: white noise, differenced and filtered like a log.
TEST_CASE("noise left in velocity and acceleration is what the closed form says", "[samples]") {
  Normal noise(5301);
  Columns log{{{"t", {}}, {"theta", {}}}};
  for (int i = 0; i < 40000; ++i) {
    log.columns[0].second.push_back(1e-3 * i);
    log.columns[1].second.push_back(1e-4 * noise());
  }
  Bench bench;
  RowSettings settings;
  settings.signal.cutoff = 60;
  settings.drop_edge = 200;
  const EquationBatch rows = all_rows(bench.add_text(log.csv()), settings, plain_equation());
  const double n = static_cast<double>(rows.rows.rows());
  // The closed form has a brick wall at the cut-off. Two passes of order 4 are 1/(1 + x^8)^2, for
  // which int x^2 and int x^4 are 0.2656 and 0.1594 instead of 1/3 and 1/5: 0.893 of the sd, both.
  // About 5000 independent rows know an sd to 1 %; the triangle average takes another 1 %.
  CHECK_THAT(rows.rows.col(1).norm() / std::sqrt(n),
             Catch::WithinRel(0.893 * velocity_noise(1e-4, 60, 1000), 0.04));
  CHECK_THAT(rows.rows.col(2).norm() / std::sqrt(n),
             Catch::WithinRel(0.893 * acceleration_noise(1e-4, 60, 1000), 0.04));
}

TEST_CASE("edges and margins last as long in a log of any rate", "[samples]") {
  const Columns fast = noisy_log(20000, 5400);
  Columns slow{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (std::size_t i = 0; i < 20000; i += 50)
    for (std::size_t c = 0; c < 3; ++c) slow.columns[c].second.push_back(fast.columns[c].second[i]);
  Bench bench;
  bench.add_text(fast.csv());
  bench.add_text(slow.csv());
  const ChosenSettings chosen = moving_settings(bench.logs(), kAllParts, {}, 0);
  const double two_periods = 2 / chosen.rows.signal.cutoff;
  CHECK(chosen.rows.rate == Approx(20));
  CHECK(static_cast<double>(chosen.rows.drop_edge) / 20 == Approx(two_periods).margin(0.05));
  const RowSettings at_1_khz = at_rate(chosen.rows, 1000);
  CHECK(at_1_khz.drop_edge == 50 * chosen.rows.drop_edge);
  CHECK(at_1_khz.rest_margin == 50 * chosen.rows.rest_margin);
  CHECK(at_1_khz.decimate == chosen.rows.decimate);
  // A clock that is a little off is no other rate.
  CHECK(at_rate(chosen.rows, 20.1).drop_edge == chosen.rows.drop_edge);
  // Counted in rows of the fast log the edges would be longer than the slow one.
  WindowCounts windows;
  const EquationBatch rows = all_rows(bench.logs()[1], chosen.rows, plain_equation(), 1, &windows);
  CHECK(windows.rows_too_short == 0);
  CHECK(rows.rows.rows() > 200 / chosen.rows.decimate);
}

TEST_CASE("settings of a blocked log are quasi-static", "[samples]") {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv")};
  const ChosenSettings chosen = blocked_settings(logs, kAllParts, {});
  CHECK(chosen.rows.signal.cutoff == 10);
  CHECK(decision(chosen, "cut-off").reason == "quasi-static");
  CHECK(chosen.rows.decimate == 20);  // 500 / (2.5 * 10)
  // A sweep of +-45 mrad in 8 s: speeds up to 2 pi 0.045 / 8 = 35 mrad/s and half as much again.
  // Rest is below 5 % of that.
  CHECK(chosen.rest_speed_theta > 0.05 * 0.02);
  CHECK(chosen.rest_speed_theta < 0.05 * 0.06);
}

TEST_CASE("the rig's sensor data replace the log's", "[samples]") {
  LogSurvey log = shipped("low/moving_load30.csv");
  const PartSurvey& part = log.parts.at(0);
  CHECK_THAT(position_noise(log, part, Channel::theta),
             Catch::WithinRel(2.4e-5 / std::sqrt(12.0), 1e-12));
  log.plan.rig.sensors["theta"] = {std::nullopt, 3e-5};
  CHECK_THAT(position_noise(log, part, Channel::theta), Catch::WithinRel(3e-5, 1e-12));
  log.plan.rig.sensors["theta"] = {4e-5, 3e-5};
  CHECK_THAT(position_noise(log, part, Channel::theta),
             Catch::WithinRel(std::hypot(4e-5 / std::sqrt(12.0), 3e-5), 1e-12));
  log.plan.rig.sensors.clear();
  CHECK(position_noise(log, part, Channel::theta) >= 2.4e-5 / std::sqrt(12.0) * (1 - 1e-6));
}

}  // namespace
