// Logs as they come: holes, uneven clocks, several parts in one file, several joints, divergence.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/simulate/true_models.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kPeriod = 1e-3;

/// None for the first 50 ms, so that the state at the start is exactly that of rest.
double torque(double t) { return t < 0.05 ? 0 : 30 * std::sin(9 * t) + 12 * std::sin(31 * t + 1); }

/// What the model does under torque(t), linear between rows, as the columns of an exact log.
Columns exact_log(const Model& model, Eigen::Index n_rows) {
  SimulationInput input = quiet_input(n_rows, kPeriod, model.rig.n_joints());
  for (Eigen::Index i = 0; i < n_rows; ++i) {
    for (int k = 0; k < model.rig.n_joints(); ++k) {
      input.tau(i, k) = (k + 1) * torque(kPeriod * static_cast<double>(i));
    }
  }
  SimulationOptions options;
  options.hold_torque = false;
  const SimulationResult motion = simulate(model, input, options);
  Columns log;
  for (Eigen::Index i = 0; i < n_rows; ++i) {
    if (i == 0) log.add("t");
    log.columns[0].second.push_back(kPeriod * static_cast<double>(i));
  }
  for (int k = 0; k < model.rig.n_joints(); ++k) {
    const std::string number = model.rig.n_joints() > 1 ? std::to_string(k + 1) : "";
    const auto column = [&](const std::string& name, const Eigen::ArrayXXd& table) {
      const Eigen::ArrayXd values = table.col(k);
      log.add(name + number).assign(values.begin(), values.end());
    };
    if (!model.rigid) column("q", motion.q);
    column("theta", motion.theta);
    column("tau", input.tau);
  }
  return log;
}

ReplayOptions exact_replay(double window = 0) {
  ReplayOptions options = in_mode(ReplayMode::torque);
  options.torque_hold = TorqueHold::none;
  options.window = window;
  return options;
}

SimulateResult replay(const Model& model, const std::string& log, const ReplayOptions& options) {
  const TempFolder folder;
  const std::vector<LogSurvey> logs = {
      survey_for_simulation(folder.write("log.csv", log), "", model)};
  return simulate_logs(model, logs, options);
}

void erase_rows(Columns& log, std::size_t first, std::size_t n_rows) {
  for (auto& [name, values] : log.columns) {
    const auto begin = values.begin() + static_cast<long>(first);
    values.erase(begin, begin + static_cast<long>(n_rows));
  }
}

TEST_CASE("a log that the model itself made is met, in long blocks too", "[simulate]") {
  const Model model = true_model("low");  // 20000 rows: three blocks of a log's window
  const SimulateResult result = replay(model, exact_log(model, 20000).csv(), exact_replay());
  const SimulatedPart& part = result.parts.at(0);
  CHECK(part.n_rows == 20000);
  CHECK(gap_of(part, "q").max_abs < 1e-12);
  CHECK(gap_of(part, "theta").max_abs < 1e-12);
}

TEST_CASE("several joints", "[simulate]") {
  Model model = spring_joint({0.3, 5, 3}, {0.01, 1, 2, 0}, 2000);
  model.rig.joints = {"1", "2"};
  model.joints.push_back(model.joints[0]);
  model.transmission.n_joints = 2;
  model.transmission.theta_0 = Eigen::Vector2d::Zero();
  model.transmission.linear_stiffness = Eigen::Vector2d(2000, 3000);
  const SimulateResult result = replay(model, exact_log(model, 2000).csv(), exact_replay());
  REQUIRE(result.parts.at(0).gaps.size() == 6);
  for (const char* signal : {"q1", "theta1", "deflection1", "q2", "theta2", "deflection2"}) {
    CHECK(gap_of(result.parts[0], signal).max_abs < 1e-12);
  }
}

TEST_CASE("a rigid drive", "[simulate]") {
  const Model model = rigid_drive({0.3, 2, 3, 0.1});
  const SimulateResult result = replay(model, exact_log(model, 2000).csv(), exact_replay());
  REQUIRE(result.parts.at(0).gaps.size() == 1);
  CHECK(gap_of(result.parts[0], "theta").max_abs < 1e-12);
  CHECK(result.parts[0].cables.empty());
}

TEST_CASE("a hole begins anew from the measured state", "[simulate]") {
  const Model model = true_model("low");
  Columns log = exact_log(model, 4000);
  erase_rows(log, 1500, 200);
  const SimulateResult result = replay(model, log.csv(), exact_replay());
  const SimulatedPart& part = result.parts.at(0);
  CHECK(part.n_windows == 2);
  CHECK(part.counts.segments == 2);
  CHECK(part.n_rows == 3800);
  // The start's speed is that of a cubic through seven rows.
  CHECK(gap_of(part, "theta").max_abs < 1e-3);
  CHECK(gap_of(part, "theta").max_abs > 0);
}

TEST_CASE("an uneven clock is resampled and counted", "[simulate]") {
  const Model model = true_model("low");
  Columns log = exact_log(model, 4000);
  for (std::size_t row = 3990; row > 10; --row) {
    if (row % 3 == 0) erase_rows(log, row, 1);
  }
  const SimulateResult result = replay(model, log.csv(), exact_replay(0.5));
  const SimulatedPart& part = result.parts.at(0);
  CHECK(part.counts.rows_resampled > 2000);
  CHECK(part.n_windows > 2);
  CHECK(gap_of(part, "theta").relative < 0.05);
}

TEST_CASE("of a file of several preloads those of the model", "[simulate]") {
  const Model model = true_model("low");
  std::string text = exact_log(model, 1000).csv(), with_preload;
  std::size_t row = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const char* cell = row == 0 ? ",preload" : row <= 600 ? ",low" : ",high";
    with_preload += text.substr(at, end - at) + cell + "\n";
    at = end + 1;
    ++row;
  }
  const SimulateResult result = replay(model, with_preload, exact_replay());
  REQUIRE(result.parts.size() == 1);
  CHECK(result.parts[0].preload == "low");
  CHECK(result.parts[0].n_rows == 600);
  REQUIRE(result.warnings.size() == 1);
  CHECK(result.warnings[0].find("log.csv: preload 'high' is left out, the model is of 'low'") !=
        std::string::npos);

  Model other = model;
  other.preload = "medium";
  const SimulateResult all = replay(other, with_preload, exact_replay());
  REQUIRE(all.parts.size() == 2);
  REQUIRE(all.warnings.size() == 2);
  CHECK(all.warnings[1].find("'high' is simulated by a model of preload 'medium'") !=
        std::string::npos);
}

TEST_CASE("a rigid drive cannot move a blocked link", "[simulate]") {
  const Model model = rigid_drive({0.3, 2, 3, 0.1});
  const std::vector<LogSurvey> logs = {shipped_for(model, "low/blocked.csv")};
  CHECK(message_of([&] { (void)simulate_logs(model, logs, {}); }, CABLEFIT_DATA) ==
        "low/blocked.csv: nothing to simulate; a rigid drive needs a log in which the link is "
        "free");
}

TEST_CASE("a simulation that diverges says where, and keeps what came before", "[simulate]") {
  Model model = spring_joint({0.3, 0, 0}, {0.01, 0, 0, 0}, -2e4);  // a spring that pushes away
  const SimulateResult result =
      replay(model, exact_log(true_model("low"), 2000).csv(), exact_replay());
  const SimulatedPart& part = result.parts.at(0);
  CHECK(part.n_rows > 0);
  CHECK(part.n_rows < 100);  // e-folds in 0.7 ms
  CHECK(part.diverged.find("log.csv: the simulation diverged at t = 0.0") != std::string::npos);
  CHECK(part.diverged.find("(row " + std::to_string(part.n_rows + 1) + " of moving") !=
        std::string::npos);
  CHECK(std::isfinite(gap_of(part, "theta").rms));
}

}  // namespace
