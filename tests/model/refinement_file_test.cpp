// "refinements" of a joint in a model file.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using test::message_of;

constexpr const char* kJoint =
    R"("link": {"inertia": {"J_link": 0.339}}, "motor": {"inertia": {"J_motor": 0.0133}})";

std::string model_with(const std::string& refinements, const std::string& joint = kJoint,
                       const std::string& more = "") {
  return R"({"schema": "cablefit/model/1", )" + more + R"("joints": [{)" + joint +
         R"(, "refinements": )" + refinements + R"(}])" +
         (joint == kJoint ? R"(, "transmission": {"linear": 1500}})" : "}");
}

Model read(const std::string& text) {
  std::string choice;
  return parse_model(parse_json(text, "model.json"), "", "", choice);
}

std::string complaint(const std::string& refinements, const std::string& joint = kJoint) {
  return message_of([&] { (void)read(model_with(refinements, joint)); });
}

TEST_CASE("refinements written by hand") {
  const Model model = read(model_with(R"([
    {"name": "stribeck", "side": "motor",
     "parameters": {"amplitude": {"value": 500, "unit": "mN m", "sd": 20}, "v_s": 0.1, "exponent": 2}},
    {"name": "stiffness_asymmetry", "side": "transmission"},
    {"name": "slip", "side": "transmission", "parameters": {"slip": {"value": 0.5, "unit": "mrad"}},
     "event": {"log": 2, "time": 12.5}}])"));
  const std::vector<EffectInstance>& refinements = model.joints.at(0).added;
  REQUIRE(refinements.size() == 3);
  CHECK(refinements[0].effect == &find_candidate("stribeck", Site::motor));
  const Estimate& amplitude = refinements[0].parameters.at(0);
  CHECK(amplitude.name == "amplitude");
  CHECK(amplitude.unit == "N m");
  CHECK(amplitude.value == Approx(0.5));
  CHECK(amplitude.sd == Approx(0.02));
  CHECK(refinements[0].parameters.at(2).value == 2);
  CHECK(refinements[1].parameters.empty());
  CHECK(refinements[2].parameters.at(0).value == Approx(5e-4));
  CHECK(refinements[2].event_log == 1);
  CHECK(refinements[2].event_time == 12.5);
}

/// A value within the bounds that is no round number.
double some_value(const ParameterInfo& info) {
  const double low = std::isinf(info.lower) ? -1 : info.lower;
  const double high = std::isinf(info.upper) ? low + 2 : info.upper;
  return low + (high - low) * 0.7310585786300049;
}

TEST_CASE("every refinement written and read back is the same") {
  for (const Axes axes : {Axes::rotary, Axes::linear}) {
    const std::string rig = axes == Axes::linear ? R"("rig": {"motion": "linear"}, )" : "";
    Model model = read(
        model_with(R"([{"name": "stiffness_asymmetry", "side": "transmission"}])", kJoint, rig));
    std::vector<EffectInstance>& refinements = model.joints[0].added;
    refinements.clear();
    for (const Effect& row : cablefit::candidate_effects()) {
      EffectInstance& instance = refinements.emplace_back();
      instance.effect = &row;
      for (const ParameterInfo& info : row.parameters) {
        Estimate& estimate = instance.parameters.emplace_back();
        estimate.name = info.name;
        estimate.unit = unit_for(axes, info.unit);
        estimate.value = some_value(info);
        if (refinements.size() % 2 == 0) estimate.sd = 0.1;
      }
      if (!row.is_event) continue;
      instance.event_log = 3;
      instance.event_time = 1.25;
    }
    const Model back = read(model_json(model));
    const std::vector<EffectInstance>& again = back.joints.at(0).added;
    REQUIRE(again.size() == refinements.size());
    for (std::size_t i = 0; i < again.size(); ++i) {
      INFO(refinements[i].effect->name);
      CHECK(again[i].effect == refinements[i].effect);
      CHECK(again[i].event_log == refinements[i].event_log);
      CHECK(again[i].event_time == refinements[i].event_time);
      REQUIRE(again[i].parameters.size() == refinements[i].parameters.size());
      for (std::size_t p = 0; p < again[i].parameters.size(); ++p) {
        const Estimate &a = again[i].parameters[p], &b = refinements[i].parameters[p];
        CHECK(a.name == b.name);
        CHECK(a.unit == b.unit);
        CHECK(a.value == b.value);
        CHECK((a.sd == b.sd || (std::isnan(a.sd) && std::isnan(b.sd))));
      }
    }
    CHECK(model_json(back) == model_json(model));
  }
}

TEST_CASE("a model without refinements says nothing of them") {
  const Model model = read(R"({"schema": "cablefit/model/1", "joints": [{)" + std::string(kJoint) +
                           R"(}], "transmission": {"linear": 1500}})");
  CHECK(model.joints.at(0).added.empty());
  CHECK(model_json(model).find("refinements") == std::string::npos);
}

TEST_CASE("a refinement that cannot be") {
  CHECK(complaint(R"([{"name": "stribek", "side": "motor", "parameters": {}}])") ==
        "model.json:1:152: unknown effect 'stribek' of the motor; did you mean 'stribeck'?");
  CHECK(complaint(R"([{"name": "cogging", "side": "link", "parameters": {}}])") ==
        "model.json:1:152: unknown effect 'cogging' of the link; there is one of: motor");
  CHECK(complaint(R"([{"name": "cogging", "side": "motr", "parameters": {}}])")
            .find("unknown value 'motr'; did you mean 'motor'?") != std::string::npos);
  CHECK(complaint(R"([{"name": "cable_damping", "side": "transmission"}])").find("'parameters'") !=
        std::string::npos);
  CHECK(complaint(R"([{"name": "cable_damping", "side": "transmission", "parameters": {"d": 1}}])")
            .find("'damping'") != std::string::npos);
  CHECK(complaint(R"([{"name": "cable_damping", "side": "transmission",
                       "parameters": {"damping": 1, "dampling": 2}}])")
            .find("unknown parameter 'dampling'; did you mean 'damping'?") != std::string::npos);
  CHECK(complaint(R"([{"name": "cable_damping", "side": "transmission",
                       "parameters": {"damping": -1}}])")
            .find("damping = -1 N m s/rad; expected at least 0: of the cables") !=
        std::string::npos);
  CHECK(complaint(R"([{"name": "slip", "side": "transmission", "parameters": {"slip": 0.001}}])")
            .find("'event'") != std::string::npos);
  CHECK(complaint(R"([{"name": "slip", "side": "transmission", "parameters": {"slip": 0.001},
                       "event": {"log": 0, "time": 1}}])")
            .find("not the number of a log; expected 1, 2, ...: in the order given") !=
        std::string::npos);
  CHECK(complaint(R"([{"name": "cable_damping", "side": "transmission",
                       "parameters": {"damping": 1}, "event": {"time": 1}}])")
            .find("'cable_damping' is not an event; drop it") != std::string::npos);
  CHECK(complaint(R"([{"name": "cable_damping", "side": "transmission",
                       "parameters": {"damping": 1}}])",
                  R"("rigid": {"inertia": {"J": 1}})")
            .find("'cable_damping' on a rigid drive") != std::string::npos);
}

}  // namespace
