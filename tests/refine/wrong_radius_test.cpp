// A radius that is not that of the rig file, of one pulley of a finger with two joints.
#include <catch2/catch.hpp>

#include "cablefit/refine/rig_errors/radius_fit.hpp"
#include "tests/refine/refined_finger.hpp"

namespace cablefit::test {
namespace {

const DisplacementMap& pulley(const Model& model, std::size_t cable, Site side, int joint) {
  const Cable& own = model.transmission.cables.at(cable);
  return (side == Site::link ? own.link_map : own.motor_map).at(static_cast<std::size_t>(joint));
}

/// The effect is the only one, and the refined model has the radius.
void check_radius(const RefineResult& result, std::size_t cable, Site side, int joint,
                  double radius) {
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 1);
  const NamedEffect& effect = result.effects[0];
  CHECK(effect.instance.effect->name == "cable_radius");
  CHECK(effect.instance.effect->site == side);
  CHECK(effect.joint == joint);
  CHECK(effect.rivals.empty());
  CHECK(effect.evidence.gain > 0.99);
  CHECK(effect.evidence.p_value < 1e-6);
  const Model& model = result.models.at(0);
  const Estimate& r = effect.instance.parameters.at(0);
  CHECK(r.name == "radius[" + model.transmission.cables[cable].name + "]");
  CHECK(r.unit == "m");
  CHECK(std::abs(r.value - radius) < 4 * r.sd);
  CHECK(r.sd < 1e-3 * 0.01);
  CHECK(pulley(model, cable, side, joint - 1).radius(0) == r.value);
  const RefineResult& other = result.joints.at(static_cast<std::size_t>(2 - joint));
  CHECK(other.verdict == Verdict::none);
  // What the other joint had of it before is gone too.
  for (const RefineResult& one : result.joints)
    CHECK(one.torque.test_after < 1.1 * one.torque.noise_floor);
}

TEST_CASE("a wrong radius on a link is identified with cable and joint", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[1].link[1] = round_map(-0.0093);  // -0.009 in the rig file
  const RefineResult result = refined(hidden).result;
  check_radius(result, 1, Site::link, 2, -0.0093);
  CHECK(result.joints[1].reason ==
        "the link radius of cable 'extensor' is -9.3 mm by the motion of the joints (sd 0.2 um), "
        "-9 mm in the rig file");
}

TEST_CASE("a wrong radius on a motor is identified with cable and joint", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[0].motor[0] = round_map(0.0102);
  check_radius(refined(hidden).result, 0, Site::motor, 1, 0.0102);
}

TEST_CASE("a pulley that the rig file does not have is identified", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[2].link[0] = round_map(0.003);
  check_radius(refined(hidden).result, 2, Site::link, 1, 0.003);
}

TEST_CASE("a wrong radius of an arm does not change its masses", "[refine]") {
  PlainRig hidden = phalanges_rig();
  hidden.cables[0].link[1] = round_map(0.0072);
  const RefineResult result = refined_arm(hidden).result;
  check_radius(result, 0, Site::link, 2, 0.0072);
  const RefineResult right = refined_arm(phalanges_rig()).result;
  for (std::size_t k = 0; k < right.models.at(0).arm.size(); ++k) {
    const Estimate &a = result.models.at(0).arm[k], &b = right.models[0].arm[k];
    INFO(a.name);
    if (std::isfinite(a.sd) && std::isfinite(b.sd))
      CHECK(std::abs(a.value - b.value) < 5 * std::hypot(a.sd, b.sd));
  }
}

TEST_CASE("a wrong radius is identified beside an effect of another joint", "[refine]") {
  PlainRig hidden = tendon_finger();
  find_joint_effect("stribeck", "motor").hide(hidden, 0, 1);
  hidden.cables[1].link[1] = round_map(-0.0093);
  const RefineResult result = refined(hidden).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 2);
  CHECK(result.effects[0].instance.effect->name == "stribeck");
  CHECK(result.effects[0].joint == 1);
  CHECK(result.effects[1].instance.effect->name == "cable_radius");
  CHECK(result.effects[1].joint == 2);
}

TEST_CASE("only round pulleys that a rig file gives can have a wrong radius", "[refine]") {
  const Finger finger = refined(tendon_finger());
  Model model = finger.result.models.at(0);
  // Two links and a motor of each long cable. The third has a motor, and a radius of 0 on link 1;
  // its pulley on link 2 is not round.
  CHECK(pulleys_of(model).size() == 8);
  model.rig.cables_given = false;
  CHECK(pulleys_of(model).empty());
}

}  // namespace
}  // namespace cablefit::test
