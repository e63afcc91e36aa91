// "motor_radius": {"search": r} in a rig file: read, written back and refused.
#include "cablefit/model/rig/searched_radius.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using test::message_of;

std::string rig_with(const std::string& motor_radius, const std::string& link_radius = "0.05") {
  return fmt::format(R"({{"cables": [{{"name": "a", "motor_radius": {}, "link_radius": {}}}]}})",
                     motor_radius, link_radius);
}

Rig parsed(const std::string& text) { return parse_rig(parse_json(text, "rig.json")); }

std::string complaint(const std::string& motor_radius, const std::string& link_radius = "0.05") {
  return message_of([&] { parsed(rig_with(motor_radius, link_radius)); });
}

TEST_CASE("a rig file searches a motor radius") {
  for (const char* text : {R"({"search": -0.02})", R"([{"search": -0.02}])"}) {
    const Rig rig = parsed(rig_with(text));
    CHECK(searched_radii(rig.transmission) == SearchedRadii{0});
    CHECK(rig.transmission.cables[0].motor_map[0].radius(0.3) == -0.02);
  }
  CHECK_FALSE(searches_radius(parsed(rig_with("-0.02")).transmission));
}

TEST_CASE("a motor radius that was found is no longer searched") {
  Rig rig = parsed(rig_with(R"({"search": 0.02})"));
  set_reference(rig.transmission,
                {Eigen::VectorXd::Constant(1, 0.1), Eigen::VectorXd::Constant(1, 0.3)});
  set_motor_radius(rig.transmission, 0, 0, 0.025);
  CHECK_FALSE(searches_radius(rig.transmission));
  // l stays l_o in the reference pose: 0.025 m * 0.3 rad - 0.05 m * 0.1 rad.
  CHECK(rig.transmission.cables[0].reference_displacement == Approx(0.0025).epsilon(1e-12));
}

TEST_CASE("what cannot be searched of a radius is refused") {
  CHECK(
      complaint(R"("search")") ==
      "rig.json:1:43: a search of a radius needs a value to start from; give {\"search\": r} with "
      "the signed nominal radius r in m");
  CHECK(
      complaint(R"({"search": 0})") ==
      "rig.json:1:54: a search of a radius cannot start from 0; give the signed nominal radius in "
      "m");
  CHECK(complaint(R"({"type": "polynomial", "coefficients": [0.02, 0.001], "search": 0.02})") ==
        "rig.json:1:43: only the radius of a round pulley can be searched; give {\"search\": r} "
        "alone, or this map as it is");
  CHECK(complaint("0.02", R"({"search": 0.05})") ==
        "rig.json:1:64: this radius cannot be searched; search \"motor_radius\", and give this one "
        "in "
        "m");
}

std::string of_two_joints(const std::string& maps) {
  return R"({"joints": [{"name": "1"}, {"name": "2"}], "cables": [{"name": "a", )" + maps +
         R"(, "link_radius": [0.05, 0]}]})";
}

TEST_CASE("a rig of several joints searches one motor radius of a cable") {
  const Rig rig = parsed(of_two_joints(R"("motor_radius": [0.01, {"search": -0.02}])"));
  CHECK(searched_radii(rig.transmission) == SearchedRadii{1});
  CHECK(rig.transmission.cables[0].motor_map[0].radius(0) == 0.01);
  CHECK(rig.transmission.cables[0].motor_map[1].radius(0) == -0.02);
  const auto complaint_of = [](const std::string& maps) {
    return message_of([&] { parsed(of_two_joints(maps)); });
  };
  CHECK(complaint_of(R"("motor_radius": [{"search": 0.02}, {"search": 0.03}])") ==
        "rig.json:1:104: a second radius of this cable is searched; search one radius of a cable, "
        "and give the others in m");
  CHECK(complaint_of(R"("motor_radius": {"search": 0.02})") ==
        "rig.json:1:85: 1 number(s), expected 2; give one per joint");
  CHECK(
      complaint_of(
          R"("motor_map": {"type": "polynomial", "joints": ["1", "2"], "coefficients": [[0], [1]]})"
          R"(, "motor_radius": [{"search": 0.02}, 0])") ==
      "rig.json:1:173: a searched radius beside motor_map; give the radius in m, or leave "
      "motor_map out");
}

TEST_CASE("a model knows its motor radii") {
  Model model;
  model.rig = parsed(rig_with(R"({"search": 0.02})"));
  model.transmission = model.rig.transmission;
  model.transmission.cables[0].coefficients = {1e5, 1e7};
  model.joints.resize(1);
  const std::string text = model_json(model);  // a rig is written as it was read
  const JsonNode root = parse_json(text, "model.json");
  CHECK(root.at("rig").at("cables").items[0].at("motor_radius").items[0].at("search").number() ==
        0.02);
  std::string choice;
  const std::string why = message_of([&] { parse_model(root, "", "", choice); });
  INFO(why);
  CHECK(
      why.ends_with(": the rig of this model searches a motor radius; give \"motor_radius\" in "
                    "m: a model knows it"));
}

}  // namespace
