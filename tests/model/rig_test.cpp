#include "cablefit/model/rig.hpp"

#include <catch2/catch.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;

constexpr const char* kEveryKey = R"json({
  // every key that a rig file may have
  "schema": "cablefit/rig/1",
  "name": "bench 3",
  "preload": "low",
  "columns": {
    "t": "time [ms]",
    "tau": {"column": "i_q", "scale": 0.083, "unit": "N m"},
    "theta": "motor [deg]",
    "q2": {"column": "elbow (mrad)", "scale": -1, "shift": 2.5},
    "run": "attempt",
    "phase": {"column": "what"}
  },
  "motion": "rotary",
  "torque_hold": "zoh",
  "torque_period": 0.002,
  "load": {"type": "column"},
  "controller": {"type": "pd", "kp": 800, "kd": 6, "limit": 250, "period": 0.0005,
                 "reference": "wanted"},
  "sensors": {"q": {"quantum": 6e-6}, "theta2": {"quantum": 2.4e-5, "noise": 1e-5},
              "tau": {"noise": 0.3}},
  "cad": {"J_link": 0.3, "J_motor[2]": 0.0019, "k[left]_1": 5e5, "l_o[right]": 0.001},
  "joints": [{"name": "shoulder"}, {"name": "elbow"}],
  "cables": [
    {"name": "left", "motor_radius": [0.02, 0], "link_radius": [0.05, 0.01]},
    {"name": "right", "motor_radius": [-0.02, 0], "link_radius": [-0.05, 0],
     "law": "polynomial", "order": 3, "initial_elongation": "search"},
    {"name": "back", "motor_radius": [0, 0.02], "link_radius": [0, 0.03], "law": "linear",
     "initial_elongation": 0.002}
  ]
})json";

TEST_CASE("a rig file with every key") {
  const Rig rig = parse_rig(parse_json(kEveryKey, "bench/rig.json"));
  CHECK(rig.path == "bench/rig.json");
  CHECK(rig.name == "bench 3");
  CHECK(rig.preload == "low");
  CHECK(rig.axes.all() == Axes::rotary);
  CHECK(rig.torque_hold == TorqueHold::zoh);
  CHECK(rig.torque_period == 0.002);
  CHECK(rig.joints == std::vector<std::string>{"shoulder", "elbow"});
  CHECK(rig.load.law == &find_load_law("column"));
  CHECK(rig.cad.at("J_motor[2]") == 0.0019);
  CHECK(rig.cad.size() == 4);

  CHECK(rig.columns.size() == 6);
  CHECK(rig.columns.at("t").column == "time");
  CHECK(rig.columns.at("t").unit == "ms");
  CHECK(rig.columns.at("tau").column == "i_q");
  CHECK(rig.columns.at("tau").scale == 0.083);
  CHECK(rig.columns.at("tau").unit == "N m");
  CHECK(rig.columns.at("theta").column == "motor");
  CHECK(rig.columns.at("theta").unit == "deg");
  CHECK(rig.columns.at("q2").column == "elbow");
  CHECK(rig.columns.at("q2").unit == "mrad");
  CHECK(rig.columns.at("q2").scale == -1);
  CHECK(rig.columns.at("q2").shift == 2.5);
  CHECK(rig.columns.at("run").column == "attempt");
  CHECK(rig.columns.at("phase").column == "what");

  REQUIRE(rig.controller);
  CHECK(rig.controller->kp == 800);
  CHECK(rig.controller->kd == 6);
  CHECK(rig.controller->limit == 250);
  CHECK(rig.controller->period == 0.0005);
  CHECK(rig.controller->reference == "wanted");
  CHECK(rig.sensors.at("q").quantum == 6e-6);
  CHECK_FALSE(rig.sensors.at("q").noise);
  CHECK(rig.sensors.at("theta2").noise == 1e-5);
  CHECK(rig.sensors.at("tau").noise == 0.3);
}

TEST_CASE("a rig file's cables") {
  const Rig rig = parse_rig(parse_json(kEveryKey, "rig.json"));
  CHECK(rig.cables_given);
  CHECK(rig.search_elongation == std::vector<bool>{false, true, false});
  const std::vector<Cable>& cables = rig.transmission.cables;
  REQUIRE(cables.size() == 3);
  CHECK(rig.transmission.n_joints == 2);
  CHECK(cables[0].name == "left");
  CHECK(cables[0].law == &find_cable_law("polynomial"));
  CHECK(cables[0].order == 2);
  CHECK(cables[0].motor_radii(Eigen::Vector2d::Zero()) == Eigen::Vector2d(0.02, 0));
  CHECK(cables[0].link_radii(Eigen::Vector2d::Zero()) == Eigen::Vector2d(0.05, 0.01));
  CHECK(cables[1].order == 3);
  CHECK(cables[1].initial_elongation == 0);
  CHECK(cables[2].law == &find_cable_law("linear"));
  CHECK(cables[2].order == 1);
  CHECK(cables[2].initial_elongation == 0.002);
  for (const Cable& cable : cables) CHECK(cable.coefficients.empty());
}

TEST_CASE("an empty rig file is the paper's rig") {
  const Rig empty = parse_rig(parse_json("{}", "rig.json"));
  const Rig fixed = default_rig();
  for (const Rig& rig : {empty, fixed}) {
    CHECK(rig.joints == std::vector<std::string>{"1"});
    CHECK(rig.transmission.cables.size() == 2);
    CHECK(rig.search_elongation == std::vector<bool>{false, false});
    CHECK_FALSE(rig.cables_given);
    CHECK(rig.torque_hold == TorqueHold::automatic);
    CHECK(rig.load.law == nullptr);
    CHECK_FALSE(rig.controller);
  }
  CHECK(fixed.path.empty());
}

TEST_CASE("a torque may be a command, which no controller made") {
  const Rig rig = parse_rig(parse_json(R"({"controller": {"type": "open_loop"}})", "rig.json"));
  CHECK(rig.open_loop);
  CHECK_FALSE(rig.controller);
  CHECK_FALSE(parse_rig(parse_json(R"({"controller": {"kp": 3}})", "rig.json")).open_loop);
  CHECK_FALSE(default_rig().open_loop);
}

TEST_CASE("each joint may have a controller of its own") {
  const std::string joints = R"("joints": [{"name": "a"}, {"name": "b"}])";
  const auto read = [&](const std::string& controllers) {
    return parse_rig(
        parse_json("{" + joints + ", \"controller\": " + controllers + "}", "rig.json"));
  };
  const Rig rig = read(R"([{"kp": 90, "kd": 1, "limit": 5}, {"type": "pid", "kp": 40, "ki": 2}])");
  REQUIRE(rig.controller);
  CHECK(rig.controller->of(0).kp == 90);
  CHECK(rig.controller->of(0).limit == 5);
  CHECK(rig.controller->of(1).kp == 40);
  CHECK(rig.controller->of(1).ki == 2);
  CHECK(rig.controller->reference == "theta_ref");
  const Rig common = read(R"({"kp": 7})");
  CHECK(common.controller->joints.empty());
  CHECK(common.controller->of(1).kp == 7);

  CHECK(message_of([&] { (void)read(R"([{"kp": 9}])"); }) ==
        "rig.json:1:58: 1 controller(s), expected 2; give one per joint, or one for all joints "
        "without a list");
  CHECK(message_of([&] { (void)read(R"([{"kp": 9}, {"type": "open_loop"}])"); }) ==
        "rig.json:1:70: \"open_loop\" for one joint only; give {\"type\": \"open_loop\"} without a "
        "list: it holds for all joints");
  CHECK(message_of([&] { (void)read(R"([{"kp": 9}, {"kp": 9, "period": 0.001}])"); }) ==
        "rig.json:1:70: \"period\" or \"reference\" differs from that of the first joint; give all "
        "joints the same; columns of the reference are numbered by joint");
}

TEST_CASE("a single joint may be numbered, and radii be scalars") {
  const Rig rig = parse_rig(parse_json(R"({"columns": {"q1": "link"}, "motion": "linear",
      "cables": [{"name": "a", "motor_radius": 0.02, "link_radius": 0.05}]})",
                                       "rig.json"));
  CHECK(rig.columns.at("q1").column == "link");
  CHECK(rig.axes.all() == Axes::linear);
  CHECK(rig.transmission.cables[0].link_map[0].radius(0) == 0.05);
}

TEST_CASE("the rig of a log: named, beside it, or the default") {
  const test::TempFolder folder;
  const std::string log = folder.file("log.csv");
  CHECK(rig_for_log(log, "").path.empty());
  const std::string beside = folder.write("rig.json", R"({"name": "beside"})");
  const std::string other = folder.write("other.json", R"({"name": "named"})");
  CHECK(rig_for_log(log, "").name == "beside");
  CHECK(rig_for_log(log, "").path == beside);
  CHECK(rig_for_log(log, other).name == "named");
  CHECK_THROWS_WITH(rig_for_log(log, folder.file("gone.json")), Catch::Contains("gone.json"));
}

TEST_CASE("pulleys may be of any shape, and cables strands") {
  const Rig rig = parse_rig(parse_json(R"({
    "joints": [{"name": "a"}, {"name": "b"}],
    "cables": [{"name": "x", "law": "strand", "toe": 0.002, "link_radius": [0.03, 0],
                "motor_radius": [{"type": "polynomial", "coefficients": [0.02, 0.004]},
                                 {"type": "table", "angle": [-1, 0, 2], "displacement": [1, 0, 4]}]}],
    "reference_pose": {"q": [0.1, 0], "theta": [0.2, 2]}})",
                                       "rig.json"));
  const Cable& cable = rig.transmission.cables.at(0);
  CHECK(cable.toe == 0.002);
  CHECK(cable.order == 2);
  // Radius 0.02 + 0.004 x, and the parabola x^2 through the three points.
  const Eigen::VectorXd radii = cable.motor_radii(Eigen::Vector2d(0.5, 1.5));
  CHECK(radii[0] == Approx(0.022).epsilon(1e-12));
  CHECK(radii[1] == Approx(3).epsilon(1e-12));
  CHECK(cable.reference_displacement ==
        Approx(0.02 * 0.2 + 0.002 * 0.04 + 4 - 0.03 * 0.1).epsilon(1e-12));
}

}  // namespace
