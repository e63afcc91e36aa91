#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using test::message_of;
using test::TempFolder;

constexpr const char* kByHand = R"({
  // Table 1 and Table 2 of the paper, low preload
  "schema": "cablefit/model/1",
  "name": "poly",
  "preload": "low",
  "rig": {"name": "bench", "load": {"type": "hanging_mass", "mass": 40, "radius": 0.1}},
  "joints": [{
    "name": "1",
    "link": {"inertia": {"J_link": {"value": 0.339, "sd": 0.0146, "cad": 0.3}},
             "viscous": {"f_v": 5.601}, "coulomb": {"f_s": 3.274}},
    "motor": {"inertia": {"J_motor": {"value": 133, "unit": "kg cm^2", "sd": 5}},
              "viscous": {"f_vm": 1.0654}, "coulomb": {"f_sm": 2.778}, "offset": {"offset": 0.0286}}
  }],
  "transmission": {
    "cables": [{"name": "2", "coefficients": [1575.3, 29357.2], "l_o": 0.001},
               {"name": "1", "law": "polynomial", "coefficients": [1367.7, 37844.1]}],
    "theta_0": 0.002
  }
})";

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void check_equal(const Estimate& a, const Estimate& b) {
  INFO(a.name);
  CHECK(a.name == b.name);
  CHECK(a.symbol == b.symbol);
  CHECK(a.unit == b.unit);
  CHECK(same(a.value, b.value));
  CHECK(same(a.sd, b.sd));
  CHECK(same(a.sd_white, b.sd_white));
  CHECK(same(a.ci_low, b.ci_low));
  CHECK(same(a.ci_high, b.ci_high));
  CHECK(same(a.cad, b.cad));
  CHECK(a.not_identifiable == b.not_identifiable);
  CHECK(a.active_bound == b.active_bound);
}

void check_equal(const std::vector<EffectInstance>& a, const std::vector<EffectInstance>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].effect == b[i].effect);
    REQUIRE(a[i].parameters.size() == b[i].parameters.size());
    for (std::size_t p = 0; p < a[i].parameters.size(); ++p) {
      check_equal(a[i].parameters[p], b[i].parameters[p]);
    }
  }
}

void check_equal(const std::vector<DisplacementMap>& a, const std::vector<DisplacementMap>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].kind == b[k].kind);
    CHECK(a[k].parameters.coefficients == b[k].parameters.coefficients);
    CHECK(a[k].parameters.angle == b[k].parameters.angle);
    CHECK(a[k].parameters.displacement == b[k].parameters.displacement);
    CHECK(a[k].parameters.curvature == b[k].parameters.curvature);
  }
}

void check_equal(const std::vector<PairMap>& a, const std::vector<PairMap>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].kind == b[k].kind);
    CHECK(a[k].joints == b[k].joints);
    CHECK(a[k].at(0.3, -0.2).displacement == b[k].at(0.3, -0.2).displacement);
    CHECK(a[k].at(0.3, -0.2).slope == b[k].at(0.3, -0.2).slope);
  }
}

void check_equal(const Transmission& a, const Transmission& b) {
  CHECK(a.n_joints == b.n_joints);
  CHECK(a.encoder_zero() == b.encoder_zero());
  CHECK(a.linear_stiffness == b.linear_stiffness);
  REQUIRE(a.cables.size() == b.cables.size());
  for (std::size_t i = 0; i < a.cables.size(); ++i) {
    CHECK(a.cables[i].name == b.cables[i].name);
    CHECK(a.cables[i].law == b.cables[i].law);
    CHECK(a.cables[i].order == b.cables[i].order);
    CHECK(a.cables[i].coefficients == b.cables[i].coefficients);
    CHECK(a.cables[i].initial_elongation == b.cables[i].initial_elongation);
    CHECK(a.cables[i].toe == b.cables[i].toe);
    CHECK(a.cables[i].reference_displacement == b.cables[i].reference_displacement);
    check_equal(a.cables[i].motor_map, b.cables[i].motor_map);
    check_equal(a.cables[i].link_map, b.cables[i].link_map);
    check_equal(a.cables[i].motor_pairs, b.cables[i].motor_pairs);
    check_equal(a.cables[i].link_pairs, b.cables[i].link_pairs);
  }
}

void check_equal(const Model& a, const Model& b) {
  CHECK(a.name == b.name);
  CHECK(a.preload == b.preload);
  CHECK(a.rigid == b.rigid);
  REQUIRE(a.joints.size() == b.joints.size());
  for (std::size_t k = 0; k < a.joints.size(); ++k) {
    check_equal(a.joints[k].link, b.joints[k].link);
    check_equal(a.joints[k].motor, b.joints[k].motor);
  }
  check_equal(a.transmission, b.transmission);
  check_equal(a.rig.transmission, b.rig.transmission);
  REQUIRE(a.elastic.size() == b.elastic.size());
  for (std::size_t i = 0; i < a.elastic.size(); ++i) check_equal(a.elastic[i], b.elastic[i]);
}

Model read_back(const Model& model) {
  const TempFolder folder;
  std::string choice;
  return read_model(folder.write("model.json", model_json(model)), "", "", choice);
}

Model read(const std::string& text) {
  const TempFolder folder;
  std::string choice;
  return read_model(folder.write("model.json", text), "", "", choice);
}

TEST_CASE("a model file written by hand") {
  const Model model = read(kByHand);
  CHECK(model.name == "poly");
  CHECK(model.preload == "low");
  CHECK_FALSE(model.rigid);
  CHECK(model.rig.load.law == &find_load_law("hanging_mass"));
  REQUIRE(model.joints.size() == 1);
  REQUIRE(model.joints[0].link.size() == 3);
  const Estimate& inertia = model.joints[0].link[0].parameters[0];
  CHECK(inertia.name == "J_link");
  CHECK(inertia.symbol == "J_M");
  CHECK(inertia.unit == "kg m^2");
  CHECK(inertia.value == 0.339);
  CHECK(inertia.sd == 0.0146);
  CHECK(inertia.cad == 0.3);
  const Estimate& motor = model.joints[0].motor[0].parameters[0];
  CHECK(motor.value == Approx(0.0133).epsilon(1e-14));  // converted from kg cm^2
  CHECK(motor.sd == Approx(0.0005).epsilon(1e-14));
  CHECK(motor.unit == "kg m^2");

  const std::vector<Cable>& cables = model.transmission.cables;
  REQUIRE(cables.size() == 2);
  CHECK(cables[0].name == "1");
  CHECK(cables[0].coefficients == std::vector<double>{1367.7, 37844.1});
  CHECK(cables[1].initial_elongation == 0.001);
  CHECK(model.transmission.theta_0[0] == 0.002);
  REQUIRE(model.elastic.size() == 4);
  CHECK(model.elastic[3].name == "K2_1");
  CHECK(model.elastic[3].unit == "N m/rad^2");
}

TEST_CASE("a model written and read back is equal") {
  Model model = read(kByHand);
  check_equal(model, read_back(model));
  model.elastic[0].sd = 12.5;
  model.elastic[1].not_identifiable = "cable 1 was never taut";
  model.joints[0].motor[1].parameters[0].active_bound = "f_vm >= 0";
  model.joints[0].motor[2].parameters[0].ci_low = 2.5;
  model.joints[0].motor[2].parameters[0].ci_high = 3.0;
  Estimate l_o;
  l_o.name = l_o.symbol = "l_o[2]";
  l_o.unit = "rad";
  l_o.value = 0.001;
  Estimate f_sm;
  f_sm.name = f_sm.symbol = "f_sm";
  f_sm.unit = "N m";
  f_sm.value = 2.7;
  f_sm.sd = 0.1;
  model.elastic.push_back(l_o);
  model.elastic.push_back(f_sm);
  check_equal(model, read_back(model));
}

TEST_CASE("a linear and a rigid model written and read back are equal") {
  const Model linear = read(R"({"schema": "cablefit/model/1",
    "joints": [{"link": {"inertia": {"J_link": 0.4}}, "motor": {"inertia": {"J_motor": 0.02}}}],
    "transmission": {"linear": [1819.2]}})");
  CHECK(linear.name == "linear");
  CHECK(linear.transmission.cables.empty());
  CHECK(linear.elastic[0].name == "K");
  check_equal(linear, read_back(linear));
  const Model rigid = read(R"({"schema": "cablefit/model/1",
    "rig": {"motion": "linear"},
    "joints": [{"rigid": {"inertia": {"J": 95}, "viscous": {"f_v": 203}, "coulomb": {"f_s": 20},
                          "offset": {"offset": -3}}}]})");
  CHECK(rigid.name == "rigid");
  CHECK(rigid.rigid);
  CHECK(rigid.joints[0].motor[0].parameters[0].unit == "kg");
  check_equal(rigid, read_back(rigid));
}

TEST_CASE("a rig with every part survives the model file") {
  Model model = read(R"({"schema": "cablefit/model/1", "rig": {
    "name": "arm", "columns": {"tau2": {"column": "i", "scale": 2, "shift": 1, "unit": "mN m"}},
    "torque_hold": "none", "load": {"type": "none"},
    "controller": {"kp": 300, "kd": 8, "period": 0.002, "limit": 20},
    "sensors": {"q1": {"quantum": 1e-6}, "tau": {"noise": 0.2}}, "cad": {"J_link[1]": 0.3},
    "joints": [{"name": "a"}, {"name": "b"}],
    "cables": [{"name": "x", "motor_radius": [0.1, {"type": "polynomial", "coefficients": [0.2, 1]}],
                "link_radius": [{"type": "table", "angle": [0, 1, 3], "displacement": [0, 2, 1]}, 0.4],
                "order": 3},
               {"name": "y", "motor_radius": [0, 0.2], "law": "linear",
                "motor_map": {"type": "polynomial", "joints": ["b", "a"],
                              "coefficients": [[0.1, 0.2], [0.3, 0.4], [0, 1]]},
                "link_map": [{"type": "guides", "joints": ["a", "b"], "from": [-1, 0.2],
                              "to": [0.3, 0.4], "length": 0.5},
                             {"type": "grid", "joints": ["a", "b"], "angle_1": [0, 1, 3],
                              "angle_2": [-1, 1], "displacement": [[1, 2], [3, 5], [8, 7]]}],
                "initial_elongation": "search"},
               {"name": "z", "motor_radius": [0, 1], "link_radius": [0, 1], "law": "strand",
                "toe": 0.003, "order": 1}],
    "reference_pose": {"q": [0.1, 0.2], "theta": [0.3, 0.4]}},
    "joints": [{"name": "a", "link": {"inertia": {"J_link": 1}}, "motor": {"inertia": {"J_motor": 2}}},
               {"name": "b", "link": {"inertia": {"J_link": 3}}, "motor": {"inertia": {"J_motor": 4}}}],
    "transmission": {"cables": [{"name": "x", "coefficients": [1, 2, 3]},
                                {"name": "y", "law": "strand", "toe": 0.002, "coefficients": [7]},
                                {"name": "z", "coefficients": [8, 9]}]}})");
  CHECK(model.transmission.cables[1].toe == 0.002);
  CHECK(model.transmission.cables[2].toe == 0.003);
  CHECK(model.joints[1].motor[0].parameters[0].name == "J_motor[2]");
  CHECK(model.elastic[2].name == "k[x]_2");
  const Model back = read_back(model);
  check_equal(model, back);
  CHECK(back.rig.columns.at("tau2").shift == 1);
  CHECK(back.rig.columns.at("tau2").unit == "mN m");
  CHECK(back.rig.torque_hold == TorqueHold::none);
  CHECK(back.rig.load.law == model.rig.load.law);
  CHECK(back.rig.controller->period == 0.002);
  CHECK(back.rig.controller->limit == 20);
  CHECK(back.rig.sensors.at("q1").quantum == 1e-6);
  CHECK(back.rig.cad == model.rig.cad);
  CHECK(back.rig.joints == model.rig.joints);
  CHECK(back.rig.search_elongation == std::vector<bool>{false, true, false});
  CHECK(model_json(back) == model_json(model));
  model.rig.controller->joints = std::vector<Controller>(2, *model.rig.controller);
  model.rig.controller->joints[1].kp = 90;
  const Model by_joint = read_back(model);
  CHECK(by_joint.rig.controller->of(0).kp == 300);
  CHECK(by_joint.rig.controller->of(1).kp == 90);
  CHECK(by_joint.rig.controller->of(1).limit == 20);
  model.rig.controller.reset();
  model.rig.open_loop = true;
  CHECK(read_back(model).rig.open_loop);
}

TEST_CASE("a model file may name its rig file") {
  const TempFolder folder;
  folder.write("rig_low.json", R"({"name": "low bench", "preload": "low"})");
  const std::string path = folder.write("model.json", R"({"schema": "cablefit/model/1",
    "rig": "rig_low.json",
    "joints": [{"link": {"inertia": {"J_link": 0.4}}, "motor": {"inertia": {"J_motor": 0.02}}}],
    "transmission": {"linear": 1819.2}})");
  std::string choice;
  const Model model = read_model(path, "low", "", choice);
  CHECK(model.rig.name == "low bench");
  CHECK(model.preload == "low");
  CHECK(choice == "model 'linear' of " + path);
  CHECK_THROWS_WITH(read_model(path, "high", "", choice),
                    path + ":1:1: this is the model file of preload 'low'; 'high' was asked for");
}

struct BadModel {
  std::string replace, with, message;
};

const BadModel kBadModels[] = {
    {"\"f_v\"", "\"fv\"",
     "model.json:10:25: missing key 'f_v' in 'joints[0].link.viscous'; add it to this object"},
    {"\"viscous\": {\"f_v\": 5.601}", "\"viscos\": {\"f_v\": 5.601}",
     "model.json:10:24: unknown effect 'viscos' of the link; did you mean 'viscous'?"},
    {"\"f_s\": 3.274", "\"f_s\": 3.274, \"f_x\": 1",
     "model.json:10:74: unknown parameter 'f_x'; did you mean 'f_s'?"},
    {"\"J_link\": {\"value\": 0.339", "\"J_link\": {\"value\": -0.339",
     "model.json:7:13: the link of joint '1' has no positive inertia; give its \"inertia\" a value "
     "above 0"},
    {"kg cm^2", "N m",
     "model.json:11:61: unit 'N m' is of another kind; expected a unit like 'kg m^2'"},
    {"\"name\": \"2\", \"coefficients\"", "\"name\": \"3\", \"coefficients\"",
     "model.json:15:15: cable '2' of the rig is missing; give one entry per cable of the rig, by "
     "its name"},
    {"\"law\": \"polynomial\"", "\"law\": \"linear\"",
     "model.json:16:63: 2 coefficients of a linear cable; it has 1 at most"},
    {"cablefit/model/1", "cablefit/modell/1",
     "model.json:3:13: schema 'cablefit/modell/1' is not a model; expected "
     "'cablefit/model/1', or 'cablefit/dynamic/1' as `cablefit dynamic` writes it"},
    {"\"theta_0\": 0.002", "\"theta_0\": [0.002, 0]",
     "model.json:17:16: 2 value(s), expected 1; give one per joint"},
    {"\"theta_0\": 0.002", "\"linear\": 3",
     "model.json:14:19: both \"linear\" and \"cables\"; keep one of them"},
    {"\"sd\": 5", "\"std\": 5",
     "model.json:11:79: unknown key 'std' in 'joints[0].motor.inertia.J_motor'; known: value, "
     "unit, sd, rsd_percent, sd_white, ci95, cad, not_identifiable, active_bound"},
    {"\"name\": \"1\",\n    \"link\"", "\"name\": \"x\",\n    \"link\"",
     "model.json:8:13: joint 'x'; the rig calls it '1'"},
};

TEST_CASE("a wrong model file says where and what to do") {
  for (const BadModel& bad : kBadModels) {
    std::string text = kByHand;
    REQUIRE(text.find(bad.replace) != std::string::npos);
    text.replace(text.find(bad.replace), bad.replace.size(), bad.with);
    INFO(bad.replace << " -> " << bad.with);
    const TempFolder folder;
    const std::string path = folder.write("model.json", text);
    std::string choice;
    CHECK(message_of([&] { (void)read_model(path, "", "", choice); }, folder.path().string()) ==
          bad.message);
  }
}

}  // namespace
