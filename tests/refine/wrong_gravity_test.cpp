// An arm whose base leans or hangs, which its rig file does not say.
#include <catch2/catch.hpp>

#include "tests/refine/refined_finger.hpp"

namespace cablefit::test {
namespace {

/// The rig with its base turned.
PlainRig leaning(PlainRig rig, double angle, const Eigen::Vector3d& about) {
  PlainArm& arm = *rig.link_dynamics.target<PlainArm>();
  arm.gravity = Eigen::AngleAxisd(angle, about) * arm.gravity;
  return rig;
}

/// The direction is the only effect, and the masses are those of the arm.
void check_direction(const PlainRig& hidden) {
  const RefineResult result = refined_thumb(hidden).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 1);
  const NamedEffect& effect = result.effects[0];
  CHECK(effect.instance.effect->name == "gravity_direction");
  CHECK(effect.rivals.empty());
  CHECK(effect.evidence.gain > 0.99);
  CHECK(effect.evidence.p_value < 1e-6);
  const Eigen::Vector3d right = hidden.link_dynamics.target<PlainArm>()->gravity;
  Eigen::Vector3d found;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Estimate& e = effect.instance.parameters.at(static_cast<std::size_t>(k));
    INFO(e.name);
    CHECK(e.unit == "m/s^2");
    CHECK(e.sd < 0.02);
    found(k) = e.value;
  }
  CHECK((found - right).norm() < 0.02);
  for (const RefineResult& joint : result.joints)
    CHECK(joint.torque.test_after < 1.1 * joint.torque.noise_floor);
  for (const Estimate& e : result.models.at(0).arm)
    if (e.name.starts_with("MX2"))
      CHECK(e.value == Approx(0.12 * 0.1 + 0.21 * 0.048).epsilon(0.02));
}

TEST_CASE("the direction of gravity on a base that leans is identified", "[refine]") {
  check_direction(leaning(thumb_rig(), 0.1, Eigen::Vector3d::UnitX()));
}

TEST_CASE("an arm that hangs from the ceiling is identified", "[refine]") {
  check_direction(leaning(thumb_rig(), 3.1, Eigen::Vector3d::UnitY()));
}

TEST_CASE("an arm that moves in a plane shows its lean in that plane", "[refine]") {
  const RefineResult result =
      refined_arm(leaning(phalanges_rig(), 0.1, Eigen::Vector3d::UnitY())).result;
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].instance.effect->name == "gravity_direction");
  CHECK(result.effects[0].evidence.gain > 0.99);
  CHECK(result.effects[0].evidence.p_value < 1e-6);
  const std::vector<Estimate>& g = result.effects[0].instance.parameters;
  const double right[] = {-9.80665 * std::sin(0.1), 0, -9.80665 * std::cos(0.1)};
  for (const std::size_t in_plane : {0u, 2u}) {
    CHECK(std::abs(g.at(in_plane).value - right[in_plane]) < 3 * g.at(in_plane).sd);
    CHECK(g.at(in_plane).sd < 0.02);
  }
  // A lean out of the plane only scales the weights.
  CHECK(g.at(1).value == 0);
  CHECK(std::isnan(g.at(1).sd));
  CHECK(g.at(1).not_identifiable == "the logs do not determine the lean about the other axis");
  const auto joint = static_cast<std::size_t>(result.effects[0].joint - 1);
  CHECK(result.joints.at(joint).reason.ends_with("about the one axis that the logs determine"));
}

TEST_CASE("a planar arm shows its weight where the rig file says that it has none", "[refine]") {
  // Gravity along the joints' axes: without weights the fit cannot even be simulated.
  const char* const along_axes =
      R"( "arm": {"type": "urdf", "file": "finger.urdf", "gravity": [0, 9.80665, 0]},)";
  const RefineResult result = refined_rig(phalanges_rig(), phalanges_rig(), along_axes).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].instance.effect->name == "gravity_direction");
  CHECK(result.effects[0].evidence.p_value < 1e-6);
  const std::vector<Estimate>& g = result.effects[0].instance.parameters;
  CHECK(std::abs(g.at(0).value) < 3 * g.at(0).sd);
  CHECK(g.at(0).sd < 0.02);
  CHECK(g.at(2).value == Approx(-9.80665).epsilon(1e-4));
  const auto joint = static_cast<std::size_t>(result.effects[0].joint - 1);
  CHECK(result.joints.at(joint).reason ==
        "the weight of the links shows gravity 90 deg from the direction in the rig file; the logs "
        "determine a part of this turn only");
  CHECK(std::isnan(result.torque.test_before));  // with the given direction no joint was refined
  CHECK(result.torque.test_after < 1.2 * result.torque.noise_floor);
}

TEST_CASE("on a thumb that stands as its rig file says nothing is missing", "[refine]") {
  const RefineResult result = refined_thumb(thumb_rig()).result;
  CHECK(result.verdict == Verdict::none);
  for (const RefineResult& joint : result.joints) CHECK(joint.not_refined.empty());
}

TEST_CASE("an effect on one joint of a thumb is not taken for gravity", "[refine]") {
  PlainRig hidden = thumb_rig();
  find_joint_effect("stribeck", "motor").hide(hidden, 2, 1);
  const RefineResult result = refined_thumb(hidden).result;
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].instance.effect->name == "stribeck");
  CHECK(result.effects[0].joint == 3);
}

}  // namespace
}  // namespace cablefit::test
