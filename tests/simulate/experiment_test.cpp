// Closed loop or replay, whose rig, held or not: every choice and every refusal.
#include "cablefit/simulate/experiment.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "tests/simulate/true_models.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

const std::string kController = R"("controller": {"kp": 800, "kd": 6, "reference": "goal"})";

std::string in_braces(const std::string& members) {
  std::string text = "{";
  return text.append(members).append("}");
}

/// A log of ten rows with these columns, and a rig file beside it.
class OneLog {
 public:
  OneLog(const std::string& columns, const std::string& rig) {
    std::string text = columns + "\n";
    text.insert(0, "t,");
    for (int row = 0; row < 10; ++row) {
      text += std::to_string(row);
      for (std::size_t k = 0; k < n_columns(columns); ++k) {
        text.append(",").append(std::to_string(row % 3));
      }
      text += "\n";
    }
    folder_.write("log.csv", text);
    if (!rig.empty()) folder_.write("rig.json", in_braces(rig));
  }
  LogSurvey survey(const Model& model) const {
    return survey_for_simulation(folder_.file("log.csv"), "", model);
  }
  Experiment plan(const Model& model, const ReplayOptions& options = {}) const {
    const LogSurvey log = survey(model);
    return plan_experiment(model, log, log.parts.at(0), options);
  }
  std::string message(const Model& model, const ReplayOptions& options = {}) const {
    return message_of([&] { (void)plan(model, options); }, folder_.path().string());
  }

 private:
  static std::size_t n_columns(const std::string& columns) {
    return static_cast<std::size_t>(std::count(columns.begin(), columns.end(), ',')) + 1;
  }
  TempFolder folder_;
};

std::string decision(const Experiment& experiment, const std::string& name) {
  for (const Decision& d : experiment.decisions) {
    if (d.name == name) return d.value + " (" + d.reason + ")";
  }
  return "none";
}

TEST_CASE("closed loop with a controller whose reference is in the log", "[simulate]") {
  const OneLog log("q,theta,goal", kController);
  const Experiment experiment = log.plan(true_model("low"));
  CHECK(experiment.simulation.closed_loop);
  CHECK(experiment.window_seconds == 0);
  CHECK(decision(experiment, "mode") ==
        "closed loop (the rig's controller, its reference in the log)");
  CHECK(decision(experiment, "torque hold") == "none");
  REQUIRE(experiment.warnings.size() == 1);
  CHECK(experiment.warnings[0] ==
        "no tau_load column and no load law in the rig file: the load torque is taken as 0; "
        "give one as \"load\" in the rig file, {\"type\": \"none\"} where there is none");
}

TEST_CASE("else the torque is replayed, in windows", "[simulate]") {
  const Experiment no_controller =
      OneLog("q,theta,tau,goal", R"("torque_hold": "none")").plan(true_model("low"));
  CHECK_FALSE(no_controller.simulation.closed_loop);
  CHECK_FALSE(no_controller.simulation.hold_torque);
  CHECK(no_controller.window_seconds == 1);
  CHECK(decision(no_controller, "mode") == "torque replay (no controller in the rig file)");

  const OneLog no_reference("q,theta,tau", kController);
  const Experiment experiment = no_reference.plan(true_model("low"));
  CHECK(decision(experiment, "mode") == "torque replay (no reference 'goal' in the log)");
  CHECK(decision(experiment, "torque hold") ==
        "zoh (default; use --torque-hold none for a measured current)");
  CHECK(no_reference.message(true_model("low"), in_mode(ReplayMode::closed_loop)) ==
        "log.csv: no reference 'goal' in the log; a closed loop needs a controller in the rig file "
        "and "
        "its reference in the log; or replay the torque");
}

TEST_CASE("options overrule", "[simulate]") {
  ReplayOptions options = in_mode(ReplayMode::torque);
  options.torque_hold = TorqueHold::none;
  options.window = 0;
  const Experiment experiment =
      OneLog("q,theta,tau,goal", kController).plan(true_model("low"), options);
  CHECK_FALSE(experiment.simulation.closed_loop);
  CHECK(decision(experiment, "mode") == "torque replay (given)");
  CHECK(decision(experiment, "torque hold") == "none (given)");
  CHECK(decision(experiment, "window") == "whole stretches (given)");
}

TEST_CASE("what a log's rig file leaves open is the model's", "[simulate]") {
  Model model = true_model("low");
  const std::string rest =
      R"(, "torque_hold": "none", "sensors": {"theta": {"quantum": 2e-5}},
          "columns": {"theta": "motor"}, "load": {"type": "constant", "torque": -3})";
  model.rig = parse_rig(parse_json(in_braces(kController + rest), "model.json"));
  const LogSurvey without_rig = OneLog("q,motor,tau,goal", "").survey(model);
  CHECK(without_rig.plan.has(Channel::theta));
  CHECK(without_rig.plan.has(Channel::theta_ref));
  CHECK(without_rig.parts.at(0).preload == "low");

  const Rig rig = OneLog("q,theta,tau", R"("load": {"type": "none"})").survey(model).plan.rig;
  CHECK(rig.load.law->name == "none");
  CHECK(rig.controller->reference == "goal");
  CHECK(rig.torque_hold == TorqueHold::none);
  CHECK(rig.sensors.at("theta").quantum == 2e-5);
}

TEST_CASE("missing channels are refused by name", "[simulate]") {
  const Model model = true_model("low");
  CHECK(OneLog("theta,tau", "").message(model) ==
        "log.csv:1: missing column 'q', needed for the initial state of a simulation; add it, or "
        "map it in a rig file; columns are t, theta, tau");
  CHECK(OneLog("q,theta", "").message(model) ==
        "log.csv:1: missing column 'tau', needed for replaying the torque; add it, or map it in a "
        "rig file; columns are t, q, theta");
  CHECK(OneLog("q,theta,tau", R"("load": {"type": "column"})").message(model) ==
        "log.csv:1: missing column 'tau_load', needed for the load that the rig file says is a "
        "column; add it, or map it in a rig file; columns are t, q, theta, tau");
  CHECK(OneLog("q,theta,tau", R"("motion": "linear")").message(model) ==
        "rig.json: 1 linear joint, the model has 1 rotary joint; simulate logs of the bench that "
        "the model is of");
}

}  // namespace
