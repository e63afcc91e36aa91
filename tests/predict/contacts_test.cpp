// Contacts of the link: the stated rates, and one in a simulated log.
#include "cablefit/predict/contacts.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "cablefit/base/random.hpp"
#include "cablefit/predict/predict.hpp"
#include "cablefit/simulate/experiment.hpp"
#include "tests/simulate/true_models.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kPeriod = 1e-3;  // s
constexpr Eigen::Index kWindowRows = 50;

/// Residual of sd 0.3 N m: 93 % of the variance white, 7 % with a correlation time of 0.2 s.
class Residual {
 public:
  double next() {
    constexpr double kSlow = 0.07, kTime = 0.2;
    const double keep = std::exp(-kPeriod / kTime);
    slow_ = keep * slow_ + std::sqrt(1 - keep * keep) * random_.normal();
    return 0.3 * (std::sqrt(kSlow) * slow_ + std::sqrt(1 - kSlow) * random_.normal());
  }
  /// So many windows, with `torque` on the link in every `every`-th of them.
  WindowSeries windows(Eigen::Index n, double torque = 0, Eigen::Index every = 1) {
    WindowSeries series(kPeriod * kWindowRows, kPeriod);
    std::vector<double> t(kWindowRows);
    Eigen::VectorXd values(kWindowRows);
    for (Eigen::Index w = 0; w < n; ++w) {
      for (Eigen::Index i = 0; i < kWindowRows; ++i) {
        t[static_cast<std::size_t>(i)] = kPeriod * static_cast<double>(w * kWindowRows + i);
        values(i) = next() - (w % every == 0 ? torque : 0);
      }
      series.add(t, values);
    }
    return series;
  }

 private:
  Random random_{11, 3};
  double slow_ = 0;
};

TEST_CASE("contacts and false alarms come at the stated rates, in coloured noise", "[predict]") {
  PredictOptions options;
  options.window = kPeriod * kWindowRows;
  constexpr double kFalse = 0.02;
  options.false_alarms_per_hour = kFalse * 3600 / options.window;
  options.detection_rate = 0.95;
  Residual residual;
  const WindowSeries quiet = residual.windows(40000);
  const WindowNoise noise = window_noise(quiet.means(), {}, quiet);
  CHECK(noise.source == "the logs without a contact");
  const ContactWatch free = watch(residual.windows(20000), noise, quiet.means(), options);
  // Every fourth window, so that each contact stands alone.
  constexpr Eigen::Index kContacts = 4000;
  const WindowSeries pushed = residual.windows(4 * kContacts, free.detector.torque, 4);
  Eigen::Index found = 0;
  for (std::size_t w = 0; w < pushed.means().size(); w += 4)
    found += std::abs(pushed.means()[w].value) > free.detector.threshold ? 1 : 0;
  const double alarms = static_cast<double>(free.n_alarms) / 20000;
  const double missed = 1 - static_cast<double>(found) / kContacts;
  std::printf("    false alarms %.4f (stated 0.02), missed %.4f of 4000 contacts (stated 0.05)\n",
              alarms, missed);
  CHECK(std::abs(alarms - kFalse) < kFalse / 5);
  CHECK(std::abs(missed - 0.05) < 0.05 / 5);
  CHECK(std::abs(static_cast<double>(*free.false_alarms) / 40000 - kFalse) < kFalse / 5);
  CHECK(free.expected_alarms == Approx(kFalse * 20000));
}

TEST_CASE("neighbouring windows are one contact, of one direction", "[predict]") {
  WindowSeries series(0.01, 0.01);
  Eigen::VectorXd values(8);
  values << 0, -5, -7, 0, 6, 6, -6, 0;
  series.add({0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07}, values);
  const ContactWatch found = watch(series, {0.5, "given"}, {}, {});
  REQUIRE(found.contacts.size() == 3);
  CHECK(found.n_alarms == 5);
  CHECK(found.contacts[0].from == Approx(0.01));
  CHECK(found.contacts[0].to == Approx(0.03));
  CHECK(found.contacts[0].torque == 7);  // what pushes the link is missing in its equation
  CHECK(found.contacts[1].torque == -6);
  CHECK(found.contacts[2].torque == 6);
}

TEST_CASE("a window that lacks a row does not count", "[predict]") {
  WindowSeries series(0.03, 0.01);
  series.add({0, 0.01, 0.02, 0.03, 0.05, 0.06, 0.07, 0.08}, Eigen::VectorXd::Ones(8));
  REQUIRE(series.means().size() == 2);
  CHECK(series.means()[1].from == Approx(0.05));  // the first window after the gap
}

/// The trap: rows of a decimated log lie half way between the places of a grid from 0.
TEST_CASE("rows half way between places make whole windows", "[predict]") {
  constexpr double kRow = 0.004;
  WindowSeries series(4 * kRow, kRow);
  std::vector<double> t;
  for (int i = 0; i < 4000; ++i) t.push_back(0.022 + kRow * i);
  series.add(t, Eigen::VectorXd::Ones(4000));
  CHECK(series.means().size() == 1000);
}

/// The true model of the low preload under a controller; `push`: torque on the link (N m) from 8 to
/// 8.4 s. Sensors as in the shipped logs.
std::string pushed_log(const TempFolder& folder, const std::string& name, double push) {
  Model model = true_model("low");
  model.rig.controller = Controller{};
  model.rig.controller->kp = 800;
  model.rig.controller->kd = 6;
  constexpr Eigen::Index kRows = 16001;
  SimulationInput input = quiet_input(kRows, kPeriod);
  input.tau_load = input.theta_ref = input.link_disturbance = Eigen::ArrayXXd::Zero(kRows, 1);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double t = kPeriod * static_cast<double>(i), turn = 2 * std::numbers::pi * t;
    input.theta_ref(i, 0) = 0.3 * std::sin(0.4 * turn) + 0.1 * std::sin(1.1 * turn);
    input.link_disturbance(i, 0) = t >= 8 && t < 8.4 ? push : 0;
  }
  SimulationOptions options;
  options.closed_loop = true;
  const SimulationResult r = simulate(model, input, options);
  Random random(7, 1);
  std::string text = "t,q,theta,tau,tau_load\n";
  for (Eigen::Index i = 0; i < kRows - 1; ++i)
    text += fmt::format("{:.3f},{:.9f},{:.9f},{:.6f},0\n", kPeriod * static_cast<double>(i),
                        6e-6 * std::round(r.q(i, 0) / 6e-6),
                        2.4e-5 * std::round(r.theta(i, 0) / 2.4e-5),
                        r.tau(i, 0) + 0.3 * random.normal());
  return folder.write(name, text);
}

TEST_CASE("a push in a log is found when and as large as it was", "[predict]") {
  const TempFolder folder;
  folder.write("rig.json",
               R"({"preload": "low", "torque_hold": "zoh", "load": {"type": "column"}})");
  const Model model = true_model("low");
  const std::vector<LogSurvey> pushed = {
      survey_for_simulation(pushed_log(folder, "pushed.csv", -15), "", model)};
  const std::vector<LogSurvey> quiet = {
      survey_for_simulation(pushed_log(folder, "quiet.csv", 0), "", model)};
  PredictOptions options;
  options.quiet = quiet;
  const PredictedPart part = predict_logs(model, pushed, options).parts.at(0);
  for (const Decision& d : part.decisions) INFO(d.name << ": " << d.value << " " << d.reason);
  REQUIRE(part.watches.size() == 1);
  const ContactWatch& found = part.watches.front();
  std::printf("    threshold %.3g N m, %zu alarms of %zu, %zu false of %zu\n",
              found.detector.threshold, found.n_alarms, found.n_windows, *found.false_alarms,
              *found.quiet_windows);
  REQUIRE(found.contacts.size() == 1);
  // Filters spread the edges of the push by less than two windows.
  CHECK(std::abs(found.contacts[0].from - 8) < 0.1);
  CHECK(std::abs(found.contacts[0].to - 8.4) < 0.1);
  CHECK(std::abs(found.contacts[0].torque + 15) < 3);
  CHECK(*found.false_alarms <= 2);
}

TEST_CASE("the link's torque without a sensor is that which acts", "[predict]") {
  // The logged load left out: what the model senses is then the load itself.
  const Model model = true_model("low");
  const std::vector<LogSurvey> logs = {shipped_for(model, "low/moving_load30.csv")};
  const PredictedPart part = predict_logs(model, logs, {}).parts.at(0);
  const auto sensed = [&](const std::string& signal) {
    for (const SensedTorque& torque : part.torques)
      if (torque.signal == signal) return torque;
    throw std::runtime_error("no " + signal);
  };
  CHECK(sensed("tau_load").is_measured);
  CHECK(sensed("tau_load").relative < 0.05);  // of 30 N m, in motion at up to 4 rad/s
  CHECK(sensed("tau").relative < 0.05);
}

TEST_CASE("a blocked link's motor torque is the cables' and dry friction", "[predict]") {
  const Model model = true_model("low");
  const std::vector<LogSurvey> logs = {shipped_for(model, "low/blocked.csv")};
  const PredictedPart part = predict_logs(model, logs, {}).parts.at(0);
  REQUIRE(part.torques.size() == 1);
  CHECK(part.torques[0].signal == "tau");
  // +-f_sm with the direction of the motion, and 0.3 N m of noise; less where the motor rests.
  const double friction = truth::Rig::low().f_sm;
  CHECK(part.torques[0].rms < std::hypot(friction, 0.3) * 1.02);
  CHECK(part.torques[0].rms > 0.9 * friction);
  CHECK(part.watches.empty());
}

}  // namespace
