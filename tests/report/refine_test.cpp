// Refinements as JSON, text, Markdown and CSV.
#include "cablefit/report/documents/refine_document.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "cablefit/report/sections/refine_story.hpp"
#include "cablefit/report/writers/screen.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/write/refine_json.hpp"
#include "cablefit/session/replayed_torque.hpp"
#include "tests/report/results.hpp"
#include "tests/report/schema.hpp"

namespace {

using namespace cablefit;
using nlohmann::json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Rival rival(const std::string& name, const std::string& side, double gain, double inclusion) {
  Rival r;
  r.name = name;
  r.side = side;
  r.gain = gain;
  r.inclusion = inclusion;
  return r;
}

NamedEffect stribeck() {
  NamedEffect effect;
  effect.instance.effect = &find_candidate("stribeck", Site::motor);
  effect.instance.parameters = {test::estimate("amplitude", "N m", 0.1821, 0.0077),
                                test::estimate("v_s", "rad/s", 0.1358, 0.0068),
                                test::estimate("exponent", "", 1.88, 0.21)};
  effect.evidence = {0.244, 1.308, 1.023, 2.1e-45, true, 1, 24};
  effect.torque_rms = 0.093;
  return effect;
}

RefineResult named() {
  RefineResult r;
  r.inputs = {{"slow.csv", std::string(64, 'a'), 16000},
              {"out/identify.json", std::string(64, 'b'), 0}};
  r.model_path = "out/identify.json";
  r.model_choice = "preload 'low', model 'poly'";
  r.preloads = {"low"};
  r.verdict = Verdict::named;
  r.reason = "93 % of the squared gap above the noise floor closed";
  r.where = {{"motor", "speed", "thetad", -0.3862, 0.2081, 0.76, 0.41, 0.117, 0.0854},
             {"motor", "speed", "thetad", 0.2081, 0.3, 0.2, 0.1, 0.117, 0.0854},
             {"motor", "position", "theta", -0.3862, 0.2081, 0.76, 0.41, 0.117, 0.0854},
             {"link", "direction", "sgn(qd)", -1, 0, 0.9, 0.5, 0.05, 0.036}};
  r.effects = {stribeck()};
  r.ranking = {rival("stribeck", "motor", 0.89, 1), rival("quadratic_drag", "motor", 0.44, 0),
               rival("stribeck", "link", -0.1, 0)};
  r.ranking.back().refused = "a negative friction";
  r.not_separable = {{{"asymmetric_coulomb (motor)"}, true, false, "", -1, {}},
                     {{"torque_delay (sensor)", "cable_damping (transmission)"},
                      false,
                      false,
                      "at a load of +20 N m",
                      2,
                      {}}};
  r.remainder_link = 0.0037;
  r.remainder_motor = 0.015;
  r.floor_link = 0.0363;
  r.floor_motor = 0.0854;
  r.rho_before = 1.308;
  r.rho_after = 1.023;
  r.steps = {{"stribeck", "motor", true, "", 0.0864, 0.0871, 0.1016}};
  r.torque = {0.0977, 0.0864, 0.1063, 0.1016, 0.0854, {}, {}, true};
  r.shifts = {{"J_motor", "kg m^2", 0.01528, 0.015284, 5.7e-5},
              {"f_vm", "N m s/rad", 1.0606, 1.1439, 0.0043},
              {"f_sm", "N m", 2.8757, 2.7682, 0.0044}};
  r.models.emplace_back().preload = "low";
  return r;
}

RefineResult ambiguous() {
  RefineResult r = named();
  r.verdict = Verdict::ambiguous;
  Rival close = rival("quadratic_drag", "motor", 0.85, 0.2);
  close.difference = 1.34;
  close.experiment = "slow sweeps through several speeds";
  Rival alias = rival("asymmetric_coulomb", "motor", 0, 0);
  alias.by_rule = true;
  r.effects.front().rivals = {close, alias};
  r.next_experiment = close.experiment;
  r.held_out_blocks = true;
  r.simulation = {kNone, kNone, 9.1e-4, 1.2e-4, 1e-4, {8e-4, 1e-3}, {1.1e-4, 1.3e-4}, true};
  return r;
}

RefineResult nothing() {
  RefineResult r = named();
  r.verdict = Verdict::none;
  r.reason = "nothing improves on the noise floor";
  r.effects.clear();
  r.where.clear();
  r.steps.clear();
  r.rigid = true;
  return r;
}

/// A model that was refined before.
RefineResult again() {
  RefineResult r = nothing();
  KeptEffect& kept = r.kept.emplace_back();
  kept.now = stribeck();
  kept.given = {test::estimate("amplitude", "N m", 0.19, 0.01),
                test::estimate("v_s", "rad/s", 0.14, 0.01),
                test::estimate("exponent", "", 2, kNone)};
  return r;
}

const std::vector<std::string> kFiles = {"refined.json"};

TEST_CASE("a refinement is as its schema says") {
  for (RefineResult r : {named(), ambiguous(), nothing(), again()}) {
    CHECK(test::schema_errors("refine", refine_json(r, kFiles)) == "");
    r.shifts.front().sd = kNone;
    r.decisions = {{"test logs", "held out", "none were given"}};
    CHECK(test::schema_errors("refine", refine_json(r, kFiles)) == "");
  }
}

TEST_CASE("a refinement as JSON: what scripts rely on") {
  const json j = json::parse(refine_json(ambiguous(), kFiles));
  CHECK(j["schema"] == "cablefit/refine/1");
  CHECK(j["verdict"] == "ambiguous");
  CHECK(j["preloads"] == json{"low"});
  CHECK(j["where"][0]["share_of_squared_gap"] == 0.76);
  const json& effect = j["effects"][0];
  CHECK(effect["name"] == "stribeck");
  CHECK(effect["side"] == "motor");
  CHECK(effect["joint"] == 1);
  CHECK(effect["parameters"][0]["value"] == 0.1821);
  CHECK(effect["event"].is_null());
  CHECK(effect["evidence"]["rho_before"] == 1.308);
  CHECK(effect["evidence"]["p_value"] == 2.1e-45);
  CHECK(effect["evidence"]["p_is_fitted"] == true);
  CHECK(effect["rivals"][0]["evidence"]["gain"] == 0.85);
  CHECK(effect["rivals"][1]["alias"] == true);
  CHECK(j["gap"]["torque"]["test_after"] == 0.1016);
  CHECK(j["gap"]["torque"]["test_after_ci95"].is_null());
  CHECK(j["gap"]["simulation"]["test_after"] == 1.2e-4);
  CHECK(j["gap"]["simulation"]["test_after_ci95"] == json{1.1e-4, 1.3e-4});
  CHECK(j["steps"][0]["gap_held_out"] == 0.0871);
  CHECK(j["steps"][0]["gap_test"] == 0.1016);
  CHECK(j["remainder"]["noise_floor_motor"] == 0.0854);
  CHECK(j["next_experiment"] == "slow sweeps through several speeds");
  CHECK(j["model"] == "refined.json");
}

TEST_CASE("what a refinement does not know is null") {
  RefineResult r = nothing();
  r.shifts.front().sd = kNone;
  const json j = json::parse(refine_json(r, kFiles));
  CHECK(j["effects"].empty());
  CHECK(j["gap"]["simulation"]["test_before"].is_null());
  CHECK(j["remainder"]["link"].is_null());  // a rigid drive has none
  CHECK(j["next_experiment"].is_null());
  CHECK(j["parameter_shifts"][0]["sd"].is_null());
}

TEST_CASE("a gap before that is not known is null, and the text says so") {
  RefineResult r = named();
  r.rho_before = r.effects.front().evidence.rho_before = kNone;
  r.torque.train_before = r.torque.test_before = kNone;
  r.torque.test_before_ci = {kNone, kNone};
  const std::string text = refine_json(r, kFiles);
  CHECK(test::schema_errors("refine", text) == "");
  const json j = json::parse(text);
  CHECK(j["rho"]["before"].is_null());
  CHECK(j["effects"][0]["evidence"]["rho_before"].is_null());
  CHECK(j["gap"]["torque"]["test_before"].is_null());
  CHECK(j["gap"]["torque"]["test_after"] == 0.1016);
  const std::vector<SummaryLine> story = refine_story(r, kFiles);
  const auto gap = std::find_if(story.begin(), story.end(),
                                [](const SummaryLine& line) { return line.label == "gap"; });
  REQUIRE(gap != story.end());
  CHECK(gap->text ==
        "torque, N m rms: train not known -> 0.0864, test not known -> 0.102, noise floor 0.0854");
}

TEST_CASE("derived amplitudes stand among the parameters, and an event has its log and time") {
  RefineResult r = named();
  r.effects.front().derived = {test::estimate("amplitude", "N m", 0.5, 0.1)};
  json j = json::parse(refine_json(r, kFiles));
  CHECK(j["effects"][0]["parameters"][3]["name"] == "amplitude");
  CHECK(j["effects"][0]["parameters"][3]["value"] == 0.5);
  r.effects.front().instance.effect = &find_candidate("slip", Site::transmission);
  r.effects.front().instance.event_time = 7.25;
  j = json::parse(refine_json(r, kFiles));
  CHECK(j["effects"][0]["event"] ==
        json{{"log", "slow.csv"}, {"t", 7.25}, {"duration", "lasting"}});
}

TEST_CASE("what the model had is shown as given and as it is now, and is no new effect") {
  const json j = json::parse(refine_json(again(), kFiles));
  CHECK(j["effects"].empty());
  REQUIRE(j["kept"].size() == 1);
  CHECK(j["kept"][0]["name"] == "stribeck");
  CHECK(j["kept"][0]["given"][0]["value"] == 0.19);
  CHECK(j["kept"][0]["parameters"][0]["value"] == 0.1821);
  CHECK_FALSE(json::parse(refine_json(nothing(), kFiles)).contains("kept"));
  const std::vector<SummaryLine> story = refine_story(again(), kFiles);
  const auto kept = std::find_if(story.begin(), story.end(),
                                 [](const SummaryLine& line) { return line.label == "kept"; });
  REQUIRE(kept != story.end());
  CHECK(kept->text ==
        "stribeck (motor): amplitude 0.190 -> 0.1821 +- 0.0077 N m, v_s 0.140 -> 0.1358 +- 0.0068 "
        "rad/s, exponent 2.000 -> 1.88 +- 0.21");
  RefineResult unseen = again();
  unseen.kept.front().now.instance.parameters.front() =
      test::estimate("amplitude", "N m", 0.01, 0.02);
  const std::vector<SummaryLine> lines = refine_story(unseen, kFiles);
  CHECK(std::any_of(lines.begin(), lines.end(), [](const SummaryLine& line) {
    return line.label == "kept" && line.text.ends_with("; these logs do not show it");
  }));
}

TEST_CASE("models of several preloads are listed") {
  RefineResult r = named();
  r.models.emplace_back().preload = "high";
  const std::vector<std::string> files = {"refined_low.json", "refined_high.json"};
  const json j = json::parse(refine_json(r, files));
  CHECK(j["models"][1] == json{{"preload", "high"}, {"file", "refined_high.json"}});
}

TEST_CASE("a refinement as text") {
  CHECK(write_text(on_screen(refine_document(named(), kFiles))) == R"(What the model lacks

verdict    named: stribeck (motor); 93 % of the squared gap above the noise floor closed
effect     stribeck: a exp(-|thetad / v_s|^s) sgn(thetad); amplitude = 0.1821 +- 0.0077 N m, v_s =
           0.1358 +- 0.0068 rad/s, exponent = 1.88 +- 0.21; carries 0.0930 N m rms
evidence   removes 24 % of the squared gap above the noise floor on held-out data; p < 0.0004 (tail
           fitted to 24 simulated data sets); the best in 100 % of resamples
rivals     none; the next best, quadratic_drag (motor), removes 44 % alone
gap        torque, N m rms: train 0.0977 -> 0.0864, test 0.106 -> 0.102, noise floor 0.0854
remainder  link 0.00370 N m, motor 0.0150 N m rms above the noise floor
where      motor equation, thetad from -0.386 to 0.208 rad/s: 76 % of its squared gap in 41 % of its
           rows; 0.117 N m rms there, noise floor 0.0854
and        link equation, sgn(qd) = -1: 90 % of its squared gap in 50 % of its rows; 0.0500 N m rms
           there, noise floor 0.0360
model      refined.json

Parameters that moved

parameter  unit       before   after      sd  change
                                                [sd]
----------------------------------------------------
f_vm       N m s/rad  1.0606  1.1439  0.0043     +19
f_sm       N m        2.8757  2.7682  0.0044     -24
before: the model given, fitted to the same logs in the same way

Candidates for the first effect

                       removes of the   best in
effect          side      squared gap  resamples  why not
                                  [%]        [%]
---------------------------------------------------------------------
stribeck        motor              89        100
quadratic_drag  motor              44          0
stribeck        link              -10          0  a negative friction
)");
}

TEST_CASE("look-alikes and the run that separates them, in the story") {
  const Document document = refine_document(ambiguous(), kFiles);
  std::string story;
  for (const SummaryLine& line : document.summary) story += line.label + ": " + line.text + "\n";
  CHECK(
      story ==
      R"(verdict: ambiguous: stribeck (motor) or a similar effect; 93 % of the squared gap above the noise floor closed
effect: stribeck: a exp(-|thetad / v_s|^s) sgn(thetad); amplitude = 0.1821 +- 0.0077 N m, v_s = 0.1358 +- 0.0068 rad/s, exponent = 1.88 +- 0.21; carries 0.0930 N m rms
evidence: removes 24 % of the squared gap above the noise floor on held-out data; p < 0.0004 (tail fitted to 24 simulated data sets); the best in 100 % of resamples
rivals: quadratic_drag (motor) removes 85 %, 1.3 sd less; asymmetric_coulomb (motor) is the same in any log of the usual kind
gap: torque, N m rms: train 0.0977 -> 0.0864, test 0.106 -> 0.102, noise floor 0.0854; test: the last third of every moving log
simulation: of the test logs, mrad rms: 0.910 -> 0.120 (0.110 .. 0.130), noise floor 0.100
remainder: link 0.00370 N m, motor 0.0150 N m rms above the noise floor
where: motor equation, thetad from -0.386 to 0.208 rad/s: 76 % of its squared gap in 41 % of its rows; 0.117 N m rms there, noise floor 0.0854
and: link equation, sgn(qd) = -1: 90 % of its squared gap in 50 % of its rows; 0.0500 N m rms there, noise floor 0.0360
next run: slow sweeps through several speeds
model: refined.json
)");
}

std::string story_of(const RefineResult& result) {
  std::string story;
  for (const SummaryLine& line : refine_document(result, kFiles).summary) story += line.text + "\n";
  return story;
}

TEST_CASE("what several joints show has no share of resamples") {
  RefineResult r = named();
  RefineEvidence& evidence = r.effects.front().evidence;
  evidence.inclusion = kNone;
  evidence.n_draws = 0;
  evidence.is_beside_others = true;
  const std::string text = write_text(on_screen(refine_document(r, kFiles)));
  CHECK(text.find("removes 24 % of the squared residual on held-out data, the other values right; "
                  "p") != std::string::npos);
  CHECK(text.find("the best in") == std::string::npos);
  const json j = json::parse(refine_json(r, kFiles));
  CHECK(j["effects"][0]["evidence"]["inclusion"].is_null());
  CHECK(test::schema_errors("refine", refine_json(r, kFiles)) == "");
}

TEST_CASE("parameters that do not move are one line, not a table") {
  RefineResult r = named();
  CHECK_THAT(story_of(r), !Catch::Matchers::Contains("no parameter moved"));
  r.shifts.resize(1);  // J_motor, by 0.07 sd
  CHECK_THAT(story_of(r), Catch::Matchers::Contains("no parameter moved by more than 2 sd"));
  for (const Table& table : refine_document(r, kFiles).tables)
    CHECK(table.title != "Parameters that moved");
}

TEST_CASE("a simulated gap of a replayed torque says so, in the story and above the plots") {
  RefineResult r = ambiguous();
  const auto replayed = Catch::Matchers::Contains(
      "noise floor 0.100; the torque of the log is replayed (no controller in the rig file): "
      "positions drift whatever the model, so judge by the torque gap");
  const auto label_of = [&] { return refine_headline(r).numbers.at(1).label; };
  CHECK_THAT(story_of(r), !replayed);
  CHECK(label_of() == "simulation gap on test data, rms");
  r.decisions = {
      {std::string(kReplayedTorque), "simulations of test logs", "no controller in the rig file"}};
  CHECK_THAT(story_of(r), replayed);
  CHECK(label_of() == "simulation gap on test data (torque replayed), rms");
}

TEST_CASE("an event has its date, and a gain on held-out data where these can show it") {
  const auto judged_there =
      Catch::Matchers::Contains("an event, judged on the log in which it happens; p");
  RefineResult r = named();
  EffectInstance& slip = r.effects.front().instance;
  slip.effect = &find_candidate("slip", Site::transmission);
  slip.event_time = 7.25;
  CHECK_THAT(story_of(r), Catch::Matchers::Contains("; at 7.25 s of slow.csv; carries"));
  CHECK_THAT(story_of(r), !judged_there);
  slip.ends_with_log = true;
  r.held_out_blocks = false;
  CHECK_THAT(story_of(r), judged_there);
  r.held_out_blocks = true;
  CHECK_THAT(story_of(r), !judged_there);
  slip.effect = &find_candidate("contact", Site::link);
  CHECK_THAT(story_of(r), judged_there);
}

TEST_CASE("a story without an effect") {
  const Document document = refine_document(nothing(), kFiles);
  std::string story;
  for (const SummaryLine& line : document.summary) story += line.label + ": " + line.text + "\n";
  CHECK(story == R"(verdict: none: nothing improves on the noise floor
gap: torque, N m rms: train 0.0977, test 0.106, noise floor 0.0854
remainder: motor 0.0150 N m rms above the noise floor
model: refined.json
)");
}

TEST_CASE("the story in Markdown and its numbers as CSV") {
  const Document document = refine_document(named(), kFiles);
  const std::string markdown = write_markdown(document);
  CHECK(markdown.find("- **model**: refined.json\n\n## Parameters that moved") !=
        std::string::npos);
  const std::string csv = write_csv(document);
  CHECK(csv.find(",refined,stribeck.motor,amplitude,amplitude,N m,0.1821,0.0077,") !=
        std::string::npos);
  CHECK(csv.find(",refined,refine,gap_torque_test_after,,N m,0.1016,") != std::string::npos);
}

}  // namespace
