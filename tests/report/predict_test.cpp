// Predictions along logs, as text and as JSON.
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "cablefit/report/documents/predict_document.hpp"
#include "cablefit/report/writers/screen.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/write/predict_json.hpp"
#include "tests/report/schema.hpp"

namespace {

using namespace cablefit;

PredictedPart moving_part() {
  PredictedPart part;
  part.log = "low/moving.csv";
  part.preload = "low";
  part.phase = "moving";
  part.n_rows = part.counts.rows_read = 16000;
  part.signals = {{"tau_elas_l", "N m", -81.7, 7.2, 0.018},
                  {"elongation[1]", "rad", -0.03, 0.01, {}}};
  part.torques = {{"tau_load", "N m", "equation of the link", false, 2000, 14.9, 15.2, 8.25,
                   std::numeric_limits<double>::quiet_NaN()},
                  {"tau", "N m", "equation of the motor", true, 800, 0.13, 0.43, 11.4, 0.0036}};
  ContactWatch watch;
  watch.joint = "1";
  watch.window = 0.05;
  watch.detector.threshold = 0.5;
  watch.detector.torque = 0.8;
  watch.noise_source = "the logs without a contact";
  watch.n_windows = 240;
  watch.n_alarms = 8;
  watch.expected_alarms = 0.003;
  watch.quiet_windows = 250;
  watch.false_alarms = 1;
  watch.seconds_not_watched = 4;
  watch.contacts = {{8, 8.4, -15.1}};
  part.watches = {watch};
  return part;
}

PredictResult predict_result() {
  PredictResult result;
  result.inputs = {{"model.json", std::string(64, 'a'), 0},
                   {"low/moving.csv", std::string(64, 'b'), 16000}};
  result.model_path = "model.json";
  result.model_choice = "model 'poly' of model.json";
  result.model_name = "poly";
  result.preload = "low";
  result.parts = {moving_part()};
  return result;
}

TEST_CASE("a prediction is as its schema says") {
  PredictResult result = predict_result();
  CHECK(test::schema_errors("predict", predict_json(result)) == "");
  result.trajectories = "rows.csv";
  result.sensed = "torques.csv";
  result.rig_path = "rig.json";
  result.parts[0].watches[0].quiet_windows = result.parts[0].watches[0].false_alarms = {};
  CHECK(test::schema_errors("predict", predict_json(result)) == "");
}

TEST_CASE("a prediction as JSON") {
  const auto json = nlohmann::json::parse(predict_json(predict_result()));
  const auto& part = json["predictions"][0];
  CHECK(part["signals"][0]["band95_half_width"] == 0.018);
  CHECK(part["signals"][1]["band95_half_width"].is_null());
  CHECK(part["torques"][0]["measured"] == false);
  CHECK(part["torques"][0]["relative"].is_null());
  CHECK(part["contacts"][0]["false_alarms"] == 1);
  CHECK(part["contacts"][0]["contacts"][0]["torque"] == -15.1);
}

TEST_CASE("a prediction as text") {
  const std::string text = write_text(on_screen(predict_document(predict_result())));
  CHECK(text == R"(Prediction of the model along the logs

used      model 'poly' of model.json
contacts  1 in 240 windows of 0.05 s; 4.0 s at rest are not monitored

Predicted and measured torque

                                                                   error
log         torque      unit  by                     rows    rms  largest      at  relative
                                                                              [s]       [%]
-------------------------------------------------------------------------------------------
moving.csv  tau_load *  N m   equation of the link   2000   14.9     15.2  8.2500         -
            tau         N m   equation of the motor   800  0.130    0.430  11.400     0.360
*: not measured; the numbers are of the torque itself

Contacts, by time

log         joint    from      to  torque
                      [s]     [s]   [N m]
-----------------------------------------
moving.csv  1      8.0000  8.4000   -15.1

Elastic quantities

                                                 95 % band
log         quantity       unit  least  largest  half width
-----------------------------------------------------------
moving.csv  tau_elas_l     N m   -81.7     7.20       0.018
            elongation[1]  mrad  -30.0     10.0           -
95 % band: from the joint covariance of the elastic parameters, rms over the rows
)");
}

}  // namespace
