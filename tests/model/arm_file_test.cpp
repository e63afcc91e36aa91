// Base parameters of coupled arms in model files and results.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/model/model_parameters.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using test::message_of;
using test::TempFolder;

constexpr const char* kRig =
    R"({"joints": [{"name": "1"}, {"name": "2"}],
        "arm": {"type": "planar_two_joint", "length_1": 0.3},
        "cables": [{"name": "a", "motor_radius": [0.03, 0], "link_radius": [0.03, 0]},
                   {"name": "b", "motor_radius": [0, 0.02], "link_radius": [0, 0.02]}]})";
constexpr const char* kArm = R"({"ZZ1+M2*L1^2": {"value": 0.115, "sd": 0.002}, "ZZ2": 0.0235,
                                 "MX2": {"value": 96, "unit": "g m"}, "MY2": 0})";
constexpr const char* kLink = R"({"viscous": {"f_v": 0.05}})";
constexpr const char* kMotor = R"({"inertia": {"J_motor": 0.005}})";
constexpr const char* kCables = R"({"cables": [{"name": "a", "coefficients": [6e5, 2e7]},
                                               {"name": "b", "coefficients": [5e5, 2e7]}]})";

std::string joint(const std::string& link) {
  return fmt::format(R"({{"link": {}, "motor": {}}})", link, kMotor);
}

/// A model file; `arm`: its member, with a comma behind.
std::string model_text(const std::string& arm, const std::string& link = kLink,
                       const std::string& rig = kRig) {
  return fmt::format(
      R"({{"schema": "cablefit/model/1", "rig": {}, {} "joints": [{}, {}], "transmission": {}}})",
      rig, arm, joint(link), joint(link), kCables);
}

std::string arm_member(const std::string& arm) { return "\"arm\": " + arm + ","; }

Model read(const std::string& text) {
  std::string choice;
  return parse_model(parse_json(text, "model.json"), "", "", choice);
}

std::string refused(const std::string& text) {
  return message_of([&] { (void)read(text); });
}

TEST_CASE("a model file holds the base parameters of a coupled arm") {
  const Model model = read(model_text(arm_member(kArm)));
  CHECK(model.is_coupled());
  REQUIRE(model.arm.size() == 4);
  CHECK(model.arm[0].name == "ZZ1+M2*L1^2");
  CHECK(model.arm[0].value == 0.115);
  CHECK(model.arm[0].sd == 0.002);
  CHECK(model.arm[0].unit == "kg m^2");
  CHECK(model.arm[2].value == Approx(0.096).epsilon(1e-14));
  CHECK(model.arm[2].unit == "kg m");
  const Model back = read(model_json(model));
  REQUIRE(back.arm.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(back.arm[k].name == model.arm[k].name);
    CHECK(back.arm[k].unit == model.arm[k].unit);
    CHECK(back.arm[k].value == model.arm[k].value);
    CHECK((back.arm[k].sd == model.arm[k].sd || k > 0));
  }
  CHECK(model_json(back) == model_json(model));
}

TEST_CASE("base parameters are parameters of the model, by name") {
  Model model = read(model_text(arm_member(kArm)));
  const std::vector<ModelParameter> all = model_parameters(model);
  CHECK(all[0].kind == ParameterKind::arm);
  CHECK(all[0].name == "ZZ1+M2*L1^2");
  CHECK(all[0].lower == 0);
  CHECK(all[2].name == "MX2");
  CHECK(all[2].lower == -kUnbounded);
  CHECK(all[4].name == "f_v[1]");
  CHECK(parameter_value(model, all[1]) == 0.0235);
  set_parameter_value(model, all[1], 0.03);
  CHECK(model.arm[1].value == 0.03);
}

TEST_CASE("a model file of a coupled arm needs its base parameters") {
  CHECK(refused(model_text("")) ==
        "model.json:4:101: the model has no base parameters of its planar_two_joint arm; fit "
        "moving logs with 'cablefit dynamic', or give \"arm\"");
  CHECK(refused(model_text(arm_member(R"({"ZZ2": 0.02})"))).find("missing key 'ZZ1+M2*L1^2'") !=
        std::string::npos);
  CHECK(refused(model_text(arm_member(R"({"ZZ_2": 0.02})")))
            .ends_with("unknown base parameter 'ZZ_2'; did you mean 'ZZ2'?"));
  CHECK(refused(model_text(arm_member(kArm), R"({"inertia": {"J_link": 0.3}})"))
            .ends_with("a link of a coupled arm has no inertia of its own; drop it: the base "
                       "parameters in \"arm\" hold it"));
  const std::string undetermined =
      R"({"ZZ1+M2*L1^2": 0.1, "ZZ2": 0.02, "MX2": 0.09,
          "MY2": {"value": null, "sd": null, "not_identifiable": "joint 2 rests"}})";
  CHECK(refused(model_text(arm_member(undetermined)))
            .ends_with("base parameter 'MY2' of the arm has no value; fit logs that determine it, "
                       "or give it a value in a model file"));
}

TEST_CASE("base parameters need an arm that is coupled, and links") {
  const std::string no_arm = R"({"joints": [{"name": "1"}, {"name": "2"}],
        "cables": [{"name": "a", "motor_radius": [0.03, 0], "link_radius": [0.03, 0]},
                   {"name": "b", "motor_radius": [0, 0.02], "link_radius": [0, 0.02]}]})";
  CHECK(
      refused(model_text(arm_member(kArm), kLink, no_arm))
          .ends_with("the rig has no arm whose links are coupled; give one as \"arm\" in the rig, "
                     "or each link its \"inertia\""));
  const std::string rigid = fmt::format(
      R"({{"schema": "cablefit/model/1", "rig": {}, {} "joints": [{{"rigid": {{"inertia": {{"J": 1}}}}}},
          {{"rigid": {{"inertia": {{"J": 1}}}}}}]}})",
      kRig, "{}");
  const auto with = [&](const std::string& arm) {
    std::string text = rigid;
    return text.replace(text.find("{}"), 2, arm);
  };
  CHECK(refused(with(arm_member(kArm)))
            .ends_with("a rigid drive has no base parameters; drop \"arm\", or give every joint a "
                       "link and a motor"));
  CHECK(refused(with("")).ends_with(
      "the model has no base parameters of its planar_two_joint arm; a rigid drive moves one "
      "joint: drop \"arm\" from the rig, or fit an elastic model"));
}

TEST_CASE("a result gives its model the base parameters with their covariance") {
  const std::string text = fmt::format(
      R"({{"schema": "cablefit/dynamic/1", "preloads": [{{"name": "", "rig": {}, "fits": [
          {{"model": "poly", "parameters": [
             {{"name": "ZZ1+M2*L1^2", "unit": "kg m^2", "value": 0.115, "sd": 0.002}},
             {{"name": "ZZ2", "value": 0.0235}}, {{"name": "MX2", "value": 0.096}},
             {{"name": "MY2", "value": 0.001, "sd": 0.0004}},
             {{"name": "f_v[1]", "value": 0.05}}, {{"name": "f_v[2]", "value": 0.03}},
             {{"name": "J_motor[1]", "value": 0.005}}, {{"name": "J_motor[2]", "value": 0.004}}],
           "covariance": {{"parameters": ["ZZ1+M2*L1^2", "MY2"],
                           "matrix": [[4e-6, 1e-7], [1e-7, 1.6e-7]]}},
           "elastic": {{"parameters": [{{"name": "k[a]_0", "value": 6e5}},
             {{"name": "k[a]_1", "value": 2e7}}, {{"name": "k[b]_0", "value": 5e5}},
             {{"name": "k[b]_1", "value": 2e7}}]}}}}]}}]}})",
      kRig);
  const Model model = read(text);
  REQUIRE(model.arm.size() == 4);
  CHECK(model.arm[0].sd == 0.002);
  CHECK(model.arm[3].name == "MY2");
  CHECK(model.joints[0].link.size() == 1);
  CHECK(model.covariance.matrix(0, 1) == 1e-7);
  const Model back = read(model_json(model));
  CHECK(back.covariance.parameters == model.covariance.parameters);
  CHECK(back.arm[0].sd == 0.002);
}

}  // namespace
