// Simulations as JSON, text and CSV.
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "cablefit/report/documents/simulate_document.hpp"
#include "cablefit/report/writers/screen.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/write/simulate_json.hpp"
#include "tests/report/schema.hpp"

namespace {

using namespace cablefit;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

SimulatedPart closed_loop_part() {
  SimulatedPart part;
  part.log = "low/moving.csv";
  part.preload = "low";
  part.phase = "moving";
  part.closed_loop = true;
  part.n_windows = 1;
  part.n_rows = part.counts.rows_read = 16000;
  part.counts.segments = 1;
  part.gaps = {{"theta", "rad", 9e-6, 4.03e-5, 15.752, 4.8e-5, 6.9e-6, 9e-6, 0},
               {"tau", "N m", 0.31, 1.29, 9.972, 0.0224, 0.3, 0.31, 0}};
  part.cables = {{"1", "N m", 0, 81.7, 0.25}, {"2", "N m", 1.5, 7.2, 0}};
  part.closure_share = 0.75;
  part.decisions = {{"mode", "closed loop", "given"}};
  return part;
}

SimulatedPart replayed_part() {
  SimulatedPart part;
  part.log = "low/blocked.csv";
  part.preload = "low";
  part.phase = "blocked";
  part.held_torque = true;
  part.window_seconds = 1;
  part.n_windows = 40;
  part.n_rows = 20000;
  part.gaps = {{"q", "rad", 0, 0, 0, kNone, 1.7e-6, 0, 0}};
  part.diverged = "low/blocked.csv: the simulation diverged at t = 1 s";
  part.decisions = {{"mode", "torque replay", "no controller in the rig file"}};
  part.warnings = {"no tau_load column"};
  return part;
}

/// With the band of a model that knows its covariance.
SimulateResult with_band(SimulateResult result) {
  result.parts[0].gaps[0].band = SignalBand{2e-5, 0.97};
  return result;
}

SimulateResult simulate_result() {
  SimulateResult result;
  result.inputs = {{"model.json", std::string(64, 'a'), 0},
                   {"low/moving.csv", std::string(64, 'b'), 16000}};
  result.model_path = "model.json";
  result.model_choice = "model 'poly' of model.json";
  result.model_name = "poly";
  result.preload = "low";
  result.parts = {closed_loop_part(), replayed_part()};
  return result;
}

TEST_CASE("a simulation is as its schema says") {
  SimulateResult result = simulate_result();
  CHECK(test::schema_errors("simulate", simulate_json(result)) == "");
  CHECK(test::schema_errors("simulate", simulate_json(with_band(result))) == "");
  result.trajectories = "rows.csv";
  result.rig_path = "rig.json";
  result.parts[0].gaps.clear();  // diverged before the first row
  CHECK(test::schema_errors("simulate", simulate_json(result)) == "");
}

TEST_CASE("a simulation as JSON") {
  const auto json = nlohmann::json::parse(simulate_json(simulate_result()));
  const auto& closed = json["simulations"][0];
  CHECK(closed["mode"] == "closed loop");
  CHECK(closed["torque_held"].is_null());
  CHECK(closed["window"].is_null());
  CHECK(closed["gaps"][0]["rms"] == 9e-6);
  CHECK(closed["cables"][1]["min"] == 1.5);
  CHECK(closed["closure_share"] == 0.75);
  const auto& replayed = json["simulations"][1];
  CHECK(replayed["torque_held"] == true);
  CHECK(replayed["window"] == 1.0);
  CHECK(replayed["gaps"][0]["relative"].is_null());
  CHECK(replayed["diverged"] == "low/blocked.csv: the simulation diverged at t = 1 s");
  CHECK(json["model"]["choice"] == "model 'poly' of model.json");
}

TEST_CASE("the band of a simulation has a table of its own") {
  const auto json = nlohmann::json::parse(simulate_json(with_band(simulate_result())));
  CHECK(json["simulations"][0]["gaps"][0]["band95"]["half_width"] == 2e-5);
  CHECK(json["simulations"][0]["gaps"][1]["band95"].is_null());
  const std::string text = write_text(on_screen(simulate_document(with_band(simulate_result()))));
  CHECK_THAT(text, Catch::Matchers::Contains("\n\nUncertainty from the parameters\n\n"));
  CHECK_THAT(text, Catch::Matchers::Contains("moving.csv  theta   mrad       0.020    97.0\n"));
}

TEST_CASE("a simulation as text") {
  const std::string text = write_text(on_screen(simulate_document(simulate_result())));
  CHECK(text == R"(Simulation of the model on the input of the logs

used  model 'poly' of model.json

Gap: simulated minus measured

                                                      largest
log          mode           signal  unit      rms     gap      at  relative  sensor noise
                                                              [s]       [%]
-----------------------------------------------------------------------------------------
moving.csv   closed loop    theta   mrad  0.00900  0.0403  15.752   0.00480        0.0069
                            tau     N m     0.310    1.29  9.9720      2.24          0.30
blocked.csv  torque replay  q       mrad        0       0       0         -        0.0017
relative: rms gap / rms of the measured signal about its mean; sensor noise: sd, rounding
  included: the gap of a perfect model in closed loop
torque replay: the noise of the replayed torque adds to the gap of the positions, growing from the
  start of each window

warning: low/blocked.csv: no tau_load column
)");
}

TEST_CASE("a simulation as CSV: one row per signal") {
  const std::string csv = write_csv(simulate_document(with_band(simulate_result())));
  CHECK(csv ==
        "log,preload,phase,run,model,mode,window,rows,signal,unit,rms,max_abs,t_of_max,relative,"
        "noise,worst_window_t,worst_window_rms,band95_half_width,band95_inside\n"
        "low/moving.csv,low,moving,,poly,closed loop,0,16000,theta,rad,9e-06,4.03e-05,15.752,"
        "4.8e-05,6.9e-06,0,9e-06,2e-05,0.97\n"
        "low/moving.csv,low,moving,,poly,closed loop,0,16000,tau,N m,0.31,1.29,9.972,0.0224,0.3,0,"
        "0.31,,\n"
        "low/blocked.csv,low,blocked,,poly,torque replay,1,20000,q,rad,0,0,0,,1.7e-06,0,0,,\n");
}

}  // namespace
