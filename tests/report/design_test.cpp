// Designs as JSON, text, CSV and Markdown.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cablefit/design/design_sweep.hpp"
#include "cablefit/report/documents/design_document.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/design_models.hpp"
#include "cablefit/results/write/design_json.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/report/results.hpp"
#include "tests/report/schema.hpp"
#include "tests/simulate/benches.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using test::schema_errors;

/// A pair of linear cables on a rig, nothing else known.
DesignResult sweep_of(std::optional<double> noise) {
  Model model;
  model.rig = default_rig();
  model.transmission = antagonist_pair(1);
  model.transmission.cables[0].coefficients = {1000};
  model.transmission.cables[1].coefficients = {1000};
  DesignOptions options;
  options.torque = 20;
  options.l_o = {0, 0.01};
  options.noise = noise;
  options.figures = true;
  DesignResult result = sweep_design(model, options);
  result.model_path = "rig.json";
  result.inputs = {{"rig.json", std::string(64, 'a'), 0}};
  return result;
}

ExcitationPlan plan() {
  ExcitationPlan plan;
  plan.shape = "multisine";
  plan.limits.max_position = 0.5;
  plan.limits.max_speed = 3;
  plan.limits.max_torque = 100;
  plan.joints = {"1"};
  plan.fit.parameters = {{"link", "J_link", "kg m^2", 0.3, 0.003, 0.004, 0.006, 0.0167}};
  plan.plain.hz = 0.95;
  plan.plain.worst = 0.0333;
  plan.plain.fit.parameters = {{"link", "J_link", "kg m^2", 0.3, 0.01, 0, 0.01, 0.0333}};
  plan.plain.fit.refused = "J_link would depend on stage 1 alone";
  plan.best.worst = kUnbounded;
  plan.motion.position_share = 0.5;
  plan.motion.speed_share = 1;
  plan.motion.torque_share = 0.25;
  plan.n_tried = 200;
  return plan;
}

TEST_CASE("a preload without a fit that serves is left out of the curves and named", "[report]") {
  DynamicResult result = test::dynamic_result();
  result.preloads.push_back(test::dynamic_preload("slack"));
  std::erase_if(result.preloads.back().fits,
                [](const DynamicFit& fit) { return fit.model != "linear"; });
  const test::TempFolder folder;
  const std::string path = folder.write("dynamic.json", dynamic_json(result));
  const FittedPreloads found = other_preloads(path, "");
  CHECK(found.models.size() + 1 == result.preloads.size());
  REQUIRE(found.left_out.size() == 1);
  CHECK(found.left_out[0] == "slack: " + path +
                                 ": model 'linear' is one spring, without cables; choose one with "
                                 "cables, --model poly");
  // A result of stage 1 has no friction: nothing is missing.
  const std::string stage1 = folder.write("elastic.json", elastic_json(test::elastic_result()));
  CHECK(other_preloads(stage1, "").left_out.empty());
}

TEST_CASE("a design is valid JSON, with and without each of its parts", "[report]") {
  DesignResult result = sweep_of(0.3);
  CHECK(schema_errors("design", design_json(result)) == "");
  CHECK(schema_errors("design", design_json(sweep_of(std::nullopt))) == "");
  result.excitation = plan();
  result.excitation_path = "reference.csv";
  CHECK(schema_errors("design", design_json(result)) == "");
  const Transmission pair = antagonist_pair(1);
  result.stiffness = {stiffness_at_rest(pair)};
  result.balance = nearest_balance(pair);
  result.along = StiffnessAlong{
      "log.csv", 10, 5, 10, Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1), 1, 1};
  CHECK(schema_errors("design", design_json(result)) == "");
  Transmission stiff = pair;
  for (Cable& cable : stiff.cables) {
    cable.coefficients = {1000};
    cable.initial_elongation = 0.005;
  }
  result.held = {hold_load(stiff, Eigen::VectorXd::Constant(1, 20))};
  result.largest_tension = 50;
  result.polytopes = {torque_polytope(stiff, "at rest", stiff.reference_q(), 50)};
  result.slack_orders = slack_orders(stiff, result.polytopes.front());
  CHECK(schema_errors("design", design_json(result)) == "");
  // 15 of 20 mrad: 20 N m on 1000 N m/rad beyond 5 mrad; 10 if both acted. Slack at 2 k u = 10 N m.
  const std::string text = write_text(design_document(result));
  for (const char* line : {"20  -15.00        -10.00      33.3  1", "(1)         1 at 10.00",
                           "1      -50.00        50.00  -50.00    50.00"}) {
    INFO(text);
    CHECK(text.find(line) != std::string::npos);
  }
  result.points.clear();
  const auto json = nlohmann::json::parse(design_json(result));
  CHECK(schema_errors("design", json.dump()) == "");
  CHECK(json["excitation"]["parameters"][0]["error"].get<double>() == Approx(0.005));
  CHECK(json["excitation"]["best_sine"]["factor"].is_null());
}

/// A fit of such a pair at this preload, with friction that grows by 0.3 N m per N m of tension.
Model fit_of(const std::string& preload, double l_o) {
  Model model = test::spring_joint({0.3, 5, 3 + 0.3 * 2000 * l_o}, {0.01, 1, 2, 0}, 0);
  model.preload = preload;
  model.transmission = antagonist_pair(1);
  for (Cable& cable : model.transmission.cables) {
    cable.coefficients = {1000};
    cable.initial_elongation = l_o;
  }
  model.covariance.parameters = {"f_s"};
  model.covariance.matrix = Eigen::MatrixXd::Constant(1, 1, 0.01);
  return model;
}

// At 6 mrad, halfway: 3 + 0.3 * 12 + 2 = 8.6 N m, sd 0.1 / sqrt(2); efficiency 20 / 28.6.
TEST_CASE("two fitted preloads have friction between them in every form", "[report]") {
  DesignOptions options;
  options.torque = 20;
  options.l_o = {0.006, 0.02};
  options.fitted = {fit_of("low", 0.002), fit_of("high", 0.01)};
  options.figures = true;
  DesignResult result = sweep_design(options.fitted.front(), options);
  result.inputs = {{"fit.json", std::string(64, 'a'), 0}};
  const auto json = nlohmann::json::parse(design_json(result));
  CHECK(schema_errors("design", json.dump()) == "");
  CHECK(json["friction"].size() == 5);
  CHECK(json["fitted_preloads"][1]["joints"][0]["friction"]["at_rest"].get<double>() == Approx(11));
  const Document document = design_document(result);
  const std::string text = write_text(document);
  for (const char* line :
       {"fitted at 2 preloads (low, high): known for l_o 2.00 to 10.0 mrad and a little beyond",
        "6.000  f_dry       N m        8.600  0.071  8.461 .. 8.739",
        "6.000  efficiency  %          69.93", "20.00        -        -       -"}) {
    INFO(text);
    CHECK(text.find(line) != std::string::npos);
  }
  CHECK(write_csv(document).find("efficiency_driving") != std::string::npos);
  int n_fitted = 0;
  for (const Figure& figure : document.figures) n_fitted += figure.section == "Fitted preloads";
  CHECK(n_fitted == 5);
}

// K_linear of l_o = 0.01 under 20 N m: both taut up to 2 k u = 20 N m, so 2000 N m/rad, no error.
TEST_CASE("a design as text has the closed forms of linear cables", "[report]") {
  const Document document = design_document(sweep_of(std::nullopt));
  const std::string text = write_text(document);
  for (const char* line :
       {"l_o[1] = 10.00 mrad, l_o[2] = 10.00 mrad keeps all cables taut up to 20 N m",
        "l_o 10.00 mrad: linear 0, piecewise linear 0 N m"}) {
    INFO(text);
    CHECK(text.find(line) != std::string::npos);
  }
  CHECK(text.find(" inf") == std::string::npos);
  CHECK(text.find(" nan") == std::string::npos);
  CHECK(write_csv(document).find("closure_torque") != std::string::npos);
  CHECK(write_markdown(document).find("Effect of the preload") != std::string::npos);
  // Four curves, two along the sweep, torque and stiffness of the cables of each point.
  REQUIRE(document.figures.size() == 10);
  CHECK(document.figures.back().section == "Cables at l_o = 10 mrad");
}

// Fig. 4 of the paper, of a rig file alone: 1000 N m/rad a cable, l_o = 10 mrad.
TEST_CASE("each preload has torque and stiffness of all models against deflection", "[report]") {
  const Document document = design_document(sweep_of(std::nullopt));
  std::vector<const Figure*> cables;
  for (const Figure& figure : document.figures)
    if (figure.section == "Cables at l_o = 10 mrad") cables.push_back(&figure);
  REQUIRE(cables.size() == 2);
  CHECK(cables[0]->title == "Elastic torque of each cable");
  CHECK(cables[1]->title == "Stiffness against deflection");
  for (const Figure* figure : cables) {
    std::string names;
    for (const Trace& trace : figure->traces) names += trace.name + ";";
    CHECK(names.find("all taut: force closure;all cables;") == 0);
    CHECK(names.find("linear;piecewise linear;") != std::string::npos);
  }
  for (const double stiffness : cables[1]->traces[1].y) CHECK(stiffness == Approx(2000));
}

TEST_CASE("stiffness and balance have tables", "[report]") {
  Model model;
  model.rig = default_rig();
  model.transmission = antagonist_pair(1);
  for (Cable& cable : model.transmission.cables) cable.coefficients = {1000};
  model.transmission.cables[0].initial_elongation = 0.006;
  model.transmission.cables[1].initial_elongation = 0.009;
  DesignResult result = blank_design(model);
  REQUIRE(result.warnings.size() == 1);
  result.stiffness = {stiffness_at_rest(model.transmission)};
  result.balance = nearest_balance(model.transmission);
  const std::string text = write_text(design_document(result));
  for (const char* line : {"Stiffness of the joints at rest [N m/rad]", "tau_l     -2000   2000",
                           "tau_m     -2000   2000", "eigenvalues: 2000 with the links blocked",
                           "passive", "Nearest preload in equilibrium (8c)", "7.500"}) {
    INFO(text);
    CHECK(text.find(line) != std::string::npos);
  }
}

// With E = 0 the two tails share the alarms, with a floor they do not: more than twice the floor.
TEST_CASE("what even the cables get wrong adds to every collision torque", "[report]") {
  Model model;
  model.rig = default_rig();
  model.transmission = antagonist_pair(1);
  model.transmission.cables[0].coefficients = model.transmission.cables[1].coefficients = {1000};
  DesignOptions options;
  options.torque = 20;
  options.l_o = {0.002};
  options.noise = 0.3;
  const DesignResult exact = sweep_design(model, options);
  options.floor = 1;
  const DesignResult floor = sweep_design(model, options);
  CHECK(floor.detector->model_error == 1);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto torque = [&](const DesignResult& result) {
      return result.points[0].joints[0].models[k].collision->torque;
    };
    CHECK(torque(floor) - torque(exact) == Approx(2).margin(0.05));
  }
  CHECK(write_text(design_document(floor)).find("up to the largest and 1 N m") !=
        std::string::npos);
}

TEST_CASE("an excitation as text says what it beats, and why a sine would not do", "[report]") {
  DesignResult result;
  result.excitation = plan();
  result.excitation_path = "reference.csv";
  const std::string text = write_text(design_document(result));
  INFO(text);
  for (const char* line : {"worst error  1.7 %, of a plain sine 3.3 %: 2.0 times as much",
                           "50 % of 0.5 rad, 100 % of 3 rad/s, 25 % of 100 N m",
                           "'cablefit dynamic' refuses it: J_link would"})
    CHECK(text.find(line) != std::string::npos);
}

}  // namespace
