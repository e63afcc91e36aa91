// One joint out of several: what it keeps, what the others add to its cables, and back again.
#include "cablefit/model/one_joint.hpp"

#include <catch2/catch.hpp>

#include "tests/support/plain_rigs.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

/// The finger of plain_rigs.hpp with numbers of its own on every axis.
Model finger() {
  const TempFolder folder;
  const PlainRig plain = tendon_finger();
  Model model;
  model.rig = read_rig(folder.write("rig.json", rig_text(plain, "")));
  model.transmission = model.rig.transmission;
  for (std::size_t i = 0; i < plain.cables.size(); ++i)
    model.transmission.cables[i].coefficients = plain.cables[i].k;
  model.transmission.theta_0 = Eigen::Vector2d(0.01, -0.02);
  for (int joint = 1; joint <= 2; ++joint) {
    const FindEstimate numbered = [joint](const Estimate& blank) {
      Estimate e = blank;
      e.value = joint + 0.1 * static_cast<double>(e.name.size());
      return std::optional(e);
    };
    model.joints.push_back({base_instances(Side::link, joint, model.rig, numbered),
                            base_instances(Side::motor, joint, model.rig, numbered)});
  }
  return model;
}

TEST_CASE("a joint has the cables that pass it, and its own axes", "[model]") {
  const Model whole = finger();
  const Model first = one_joint(whole, 0), second = one_joint(whole, 1);
  CHECK(first.transmission.cables.size() == 2);  // pip does not pass the first joint
  CHECK(second.transmission.cables.size() == 3);
  CHECK(first.transmission.cables[1].name == "extensor");
  CHECK(second.transmission.theta_0[0] == -0.02);
  CHECK(second.rig.joints == std::vector<std::string>{"2"});
  CHECK(second.joints.front().motor.front().parameters.front().value ==
        whole.joints[1].motor.front().parameters.front().value);
}

TEST_CASE("own positions and those of the others make up the elongation of a cable", "[model]") {
  const Model whole = finger();
  const Eigen::Vector2d q(0.3, -0.2), theta(0.25, -0.4);
  const Eigen::VectorXd all =
      whole.transmission.elongations(q, theta);  // theta with its encoder zero: both have it
  const Eigen::ArrayXXd q_row = q.transpose().array(), theta_row = theta.transpose().array();
  const std::vector<std::vector<Eigen::Index>> places = {{0, 1}, {0, 1, 2}};
  for (int joint = 0; joint < 2; ++joint) {
    const Model one = one_joint(whole, joint);
    const Eigen::ArrayXXd others = others_elongation(one, q_row, theta_row);
    const Eigen::VectorXd own =
        one.transmission.elongations(q.segment(joint, 1), theta.segment(joint, 1));
    for (Eigen::Index k = 0; k < own.size(); ++k) {
      INFO("joint " << joint + 1 << ", cable " << one.transmission.cables[k].name);
      const Eigen::Index i = places[joint][static_cast<std::size_t>(k)];
      CHECK(own[k] + others(0, k) == Approx(all[i]).epsilon(1e-12));
    }
  }
}

TEST_CASE("a joint that was changed goes back to its place", "[model]") {
  const Model whole = finger();
  Model second = one_joint(whole, 1);
  second.joints.front().motor.front().parameters.front().value = 7;
  second.transmission.cables[2].coefficients[0] = 4e4;
  const Model back = whole_of(second);
  CHECK(back.joints[0].motor.front().parameters.front().value ==
        whole.joints[0].motor.front().parameters.front().value);
  CHECK(back.joints[1].motor.front().parameters.front().value == 7);
  CHECK(back.joints[1].motor.front().parameters.front().name == "J_motor[2]");
  CHECK(back.transmission.cables[2].coefficients[0] == 4e4);
  CHECK(back.transmission.cables[0].coefficients == whole.transmission.cables[0].coefficients);
  CHECK(back.transmission.cables[2].motor_map.size() == 2);
}

TEST_CASE("a cable with a map of two joints is of no joint alone", "[model]") {
  Model whole = finger();
  PairMap pair{&find_pair_map_kind("polynomial"), {}, {0, 1}};
  pair.parameters.values = Eigen::Matrix2d::Constant(0.01);
  whole.rig.transmission.cables[0].link_pairs = {pair};
  whole.rig.path = "rig.json";
  CHECK_THROWS_WITH(one_joint(whole, 1),
                    "rig.json: joint '" + whole.rig.joints[1] +
                        "' cannot be taken alone: cable 'flexor' has a map of two joints; use "
                        "'cablefit identify', which fits all joints together");
}

Estimate known(const std::string& name, double value, double sd) {
  Estimate e;
  e.name = name;
  e.value = value;
  e.sd = sd;
  return e;
}

TEST_CASE("of a cable that passes two joints the better known coefficients stand", "[model]") {
  const Model whole = finger();
  Model first = one_joint(whole, 0), second = one_joint(whole, 1);
  first.transmission.cables[0].coefficients[0] = 1.01e5;
  second.transmission.cables[0].coefficients[0] = 0.99e5;
  first.elastic = {known("k[flexor]_0", 1.01e5, 100)};
  second.elastic = {known("k[flexor]_0", 0.99e5, 10)};
  first.covariance = {{"f_s", "k[flexor]_0"}, Eigen::Matrix2d{{4, 1}, {1, 9}}};
  second.covariance = {{"f_s", "k[flexor]_0"}, Eigen::Matrix2d{{16, 2}, {2, 25}}};
  const std::vector<Model> both = {first, second};
  const Model all = joined(both);
  CHECK(all.transmission.cables[0].coefficients[0] == 0.99e5);
  CHECK(all.covariance.parameters == std::vector<std::string>{"f_s[1]", "f_s[2]", "k[flexor]_0"});
  CHECK(all.covariance.matrix == Eigen::Matrix3d{{4, 0, 0}, {0, 16, 2}, {0, 2, 25}});
}

TEST_CASE("a joint that holds a cable leaves it to the joint whose motor winds it", "[model]") {
  const Model whole = finger();
  Model first = one_joint(whole, 0), second = one_joint(whole, 1);
  first.transmission.cables[0].coefficients[0] = 1.01e5;
  second.transmission.cables[0].coefficients[0] = 0.99e5;  // its sd is not known
  first.transmission.cables[0].motor_map[0] = round_pulley(0);
  CHECK_FALSE(is_held(first, first.transmission.cables[0]));
  first.joints.front().holds_passing_cables = true;
  CHECK(is_held(first, first.transmission.cables[0]));
  CHECK_FALSE(is_held(first, first.transmission.cables[1]));
  const std::vector<Model> both = {first, second};
  CHECK(joined(both).transmission.cables[0].coefficients[0] == 0.99e5);
}

/// Two links in a plane with gravity, values of the six base parameters.
Model planar() {
  const TempFolder folder;
  Model model = finger();
  model.rig = read_rig(folder.write(
      "rig.json",
      rig_text(tendon_finger(),
               R"( "arm": {"type": "planar_two_joint", "length_1": 0.1, "gravity": 9.81},)")));
  const std::vector<double> values = {4e-3, 1.5e-3, 6e-3, 1e-3, 0.02, 2e-3};
  const std::vector<ParameterInfo> infos = model.rig.arm.base_parameters();
  for (std::size_t k = 0; k < infos.size(); ++k)
    model.arm.push_back(known(std::string(infos[k].name), values[k], 0.1 * values[k]));
  for (JointModel& joint : model.joints) joint.link.erase(joint.link.begin());  // no J_link
  return model;
}

/// A thumb, whose first axis is at right angles to the others.
Model spatial() {
  const TempFolder folder;
  Model model;
  model.rig = read_rig(folder.write("rig.json", rig_text(thumb_rig(), R"( "arm": {
    "type": "serial", "origins": [[0, 0, 0.01], [0, 0, 0.02], [0.1, 0, 0]],
    "axes": [[1, 0, 0], [0, 1, 0], [0, 1, 0]]},)")));
  model.joints.resize(3);
  model.transmission = model.rig.transmission;
  for (const ParameterInfo& info : model.rig.arm.base_parameters())
    model.arm.push_back(known(std::string(info.name), 1, 0.1));
  return model;
}

TEST_CASE("alone, a link of an arm turns its M_kk", "[model]") {
  const Model whole = planar();
  // M at q = 0 of a planar arm: M11 = ZZ1' + ZZ2 + 2 L1 MX2, M22 = ZZ2 (Khalil & Dombre 2004).
  const double m11 = 4e-3 + 1.5e-3 + 2 * 0.1 * 6e-3, m22 = 1.5e-3;
  const Model first = standing_alone(one_joint(whole, 0)),
              second = standing_alone(one_joint(whole, 1));
  CHECK(inertia_of(first.joints.front().link) == Approx(m11).epsilon(1e-12));
  CHECK(inertia_of(second.joints.front().link) == Approx(m22).epsilon(1e-12));
  CHECK_FALSE(first.is_coupled());
}

TEST_CASE("an equation has columns for the base parameters that it can tell", "[model]") {
  // Those of link 1 turn axis 1 alone; all that turns axis 2 is of link 2.
  CHECK(determined_arm_columns(one_joint(planar(), 0)) ==
        std::vector<Eigen::Index>{0, 1, 2, 3, 4, 5});
  CHECK(determined_arm_columns(one_joint(planar(), 1)) == std::vector<Eigen::Index>{1, 2, 3});
  Model vague = planar();
  vague.arm[2].sd = 2 * vague.arm[2].value;  // not known to within its size
  CHECK(determined_arm_columns(one_joint(vague, 1)) == std::vector<Eigen::Index>{1, 3});
}

TEST_CASE("a base parameter that turns only other axes has no column in an equation", "[model]") {
  // Links 2 and 3 turn about axes at right angles to axis 1: their moments of inertia about these
  // give no torque on it, only rounding.
  const Model whole = spatial();
  const std::vector<Eigen::Index> determined = determined_arm_columns(one_joint(whole, 0));
  std::size_t n_missing = 0;
  for (std::size_t k = 0; k < whole.arm.size(); ++k) {
    const std::string& name = whole.arm[k].name;
    const bool is_there = std::find(determined.begin(), determined.end(),
                                    static_cast<Eigen::Index>(k)) != determined.end();
    const bool turns_others = name.starts_with("YY2") || name.starts_with("YY3");
    INFO(name);
    CHECK(is_there != turns_others);
    n_missing += turns_others ? 1 : 0;
  }
  CHECK(n_missing == 2);
}

TEST_CASE("the arm's base parameters come from the joint that knows each best", "[model]") {
  const Model whole = planar();
  Model first = one_joint(whole, 0), second = one_joint(whole, 1);
  first.arm[1].value = 1.6e-3;
  first.arm[1].sd = 1e-4;
  second.arm[1].value = 1.51e-3;
  second.arm[1].sd = 1e-6;
  first.arm[0].value = 4.1e-3;
  const std::vector<Model> both = {first, second};
  const Model all = joined(both);
  CHECK(all.arm[1].value == 1.51e-3);
  CHECK(all.arm[0].value == 4.1e-3);
}

}  // namespace
}  // namespace cablefit::test
