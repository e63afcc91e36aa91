// Several joints: an effect that is hidden on one of them is named there, and nowhere else.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/refine/refined_finger.hpp"

namespace cablefit::test {
namespace {

TEST_CASE("an effect of one joint is named with its joint", "[refine]") {
  for (const std::size_t joint : {0u, 1u}) {
    INFO("joint " << joint + 1);
    PlainRig hidden = tendon_finger();
    find_joint_effect("stribeck", "motor").hide(hidden, joint, 0.6);
    const RefineResult result = refined(hidden).result;
    CHECK(result.verdict == Verdict::named);
    REQUIRE(result.effects.size() == 1);
    CHECK(result.effects[0].instance.effect->name == "stribeck");
    CHECK(result.effects[0].instance.effect->site == Site::motor);
    CHECK(result.effects[0].joint == static_cast<int>(joint) + 1);
    REQUIRE(result.joints.size() == 2);
    CHECK(result.joints[joint].verdict == Verdict::named);
    CHECK(result.joints[1 - joint].verdict == Verdict::none);
    // Most of the gap is gone on the part of the log that was held out.
    const GapStory& gap = result.joints[joint].torque;
    CHECK(gap.test_after < gap.noise_floor + 0.2 * (gap.test_before - gap.noise_floor));
    // The joined model has it, by both names of its place.
    REQUIRE(result.models.size() == 1);
    REQUIRE(result.models[0].joints.size() == 2);
    CHECK(result.models[0].joints[joint].added.size() == 1);
    CHECK(result.models[0].joints[1 - joint].added.empty());
  }
}

TEST_CASE("an effect of an arm is named with its joint", "[refine]") {
  PlainRig hidden = phalanges_rig();
  find_joint_effect("quadratic_drag", "link").hide(hidden, 1, 1);
  const RefineResult result = refined_arm(hidden).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 1);
  CHECK(result.effects[0].instance.effect->name == "quadratic_drag");
  CHECK(result.effects[0].instance.effect->site == Site::link);
  CHECK(result.effects[0].joint == 2);
  // The arm is part of the model that is written, with what the joint that knows it best says.
  CHECK(result.models.at(0).arm.size() == result.models.at(0).rig.arm.base_parameters().size());
}

TEST_CASE("friction of cables on the pulleys that they pass is named on every link", "[refine]") {
  PlainRig hidden = tendon_finger();
  find_joint_effect("path_friction", "link").hide(hidden, 0, 1);
  const RefineResult result = refined(hidden).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 2);
  // The dry friction of link 1 by the cables' force on it at rest.
  const std::vector<double> zero(2, 0.0);
  double at_rest = 0;
  for (const PlainCable& cable : hidden.cables)
    at_rest += std::abs(cable.link[0].slope(0)) * cable.force(zero, zero);
  const double mu = hidden.joints[0].f_s / at_rest;
  for (std::size_t joint = 0; joint < 2; ++joint) {
    const NamedEffect& effect = result.effects[joint];
    CHECK(effect.instance.effect->name == "path_friction");
    CHECK(effect.joint == static_cast<int>(joint) + 1);
    CHECK(effect.rivals.empty());
    CHECK(effect.instance.parameters.at(0).value == Approx(mu).epsilon(0.03));
    const GapStory& gap = result.joints[joint].torque;
    CHECK(gap.test_before > 10 * gap.noise_floor);
    CHECK(gap.test_after < 2 * gap.noise_floor);
    CHECK(result.models.at(0).joints[joint].added.size() == 1);
  }
}

TEST_CASE("where nothing is missing on any joint nothing is named", "[refine]") {
  const RefineResult result = refined(tendon_finger()).result;
  CHECK(result.verdict == Verdict::none);
  CHECK(result.effects.empty());
  for (const RefineResult& joint : result.joints) CHECK(joint.verdict == Verdict::none);
  // Friction of both joints is that of the simulation, within 4 sd of its fit.
  const PlainRig truth = tendon_finger();
  for (std::size_t joint = 0; joint < 2; ++joint)
    for (const EffectInstance& instance : result.models.at(0).joints[joint].motor) {
      const Estimate& e = instance.parameters.front();
      if (instance.effect->name != "coulomb") continue;
      CHECK(e.name == "f_sm[" + std::to_string(joint + 1) + "]");
      CHECK(std::abs(e.value - truth.joints[joint].f_sm) < 4 * e.sd);
    }
}

/// The torque of one joint is 1.2 times what it should be.
PlainRig with_wrong_torque(PlainRig rig, std::size_t joint) {
  rig.joints[joint].gain = 1.2;
  return rig;
}

TEST_CASE("other joints distinguish a wrong torque from a wrong load", "[refine]") {
  for (const std::size_t joint : {0u, 1u}) {
    INFO("joint " << joint + 1);
    const RefineResult result = refined(with_wrong_torque(tendon_finger(), joint)).result;
    CHECK(result.verdict == Verdict::named);
    REQUIRE(result.effects.size() == 1);
    const NamedEffect& effect = result.effects[0];
    CHECK(effect.instance.effect->name == "torque_gain");
    CHECK(effect.joint == static_cast<int>(joint) + 1);
    CHECK(effect.rivals.empty());
    const Estimate& a = effect.instance.parameters[0];
    CHECK(std::abs(a.value - (1 - 1.2)) < 4 * a.sd);
    CHECK(a.sd < 0.005);
    CHECK(result.joints[1 - joint].verdict == Verdict::none);
    // The cables are in the torque of the joint that is right.
    const Estimate* k = find_estimate(result.models.at(0).elastic, "k[flexor]_0");
    REQUIRE(k != nullptr);
    CHECK(std::abs(k->value - 1e5) < 5e-3 * 1e5);
  }
}

TEST_CASE("other joints distinguish a wrong load from a wrong torque", "[refine]") {
  const RefineResult result = refined(tendon_finger(), {1.2}).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 1);
  const NamedEffect& effect = result.effects[0];
  CHECK(effect.instance.effect->name == "load_scale");
  CHECK(effect.joint == 1);
  CHECK(effect.rivals.empty());
  const Estimate& a = effect.instance.parameters[0];
  CHECK(std::abs(a.value - (1 - 1.2)) < 4 * a.sd);
  CHECK(a.sd < 0.005);
}

TEST_CASE("two joints with wrong loads do not confirm each other", "[refine]") {
  const RefineResult result = refined(tendon_finger(), {1.2, 1.2}).result;
  CHECK(result.verdict == Verdict::ambiguous);
  REQUIRE(result.effects.size() == 2);
  for (const NamedEffect& effect : result.effects) {
    CHECK(effect.instance.effect->alias_class == "scale");
    REQUIRE(effect.rivals.size() == 1);
    CHECK(effect.rivals[0].by_rule);
  }
}

TEST_CASE("a wrong torque is named beside another effect of its joint", "[refine]") {
  PlainRig hidden = with_wrong_torque(tendon_finger(), 1);
  find_joint_effect("stribeck", "link").hide(hidden, 1, 1.5);
  const RefineResult result = refined(hidden).result;
  REQUIRE(result.effects.size() == 2);
  std::vector<std::string> names;
  for (const NamedEffect& effect : result.effects) {
    names.emplace_back(effect.instance.effect->name);
    CHECK(effect.joint == 2);
  }
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"stribeck", "torque_gain"});
}

TEST_CASE("without a load two wrong torques are not separable", "[refine]") {
  const RefineResult result = refined_arm(with_wrong_torque(phalanges_rig(), 1)).result;
  CHECK(result.verdict == Verdict::ambiguous);
  REQUIRE(result.effects.size() == 1);
  const NamedEffect& effect = result.effects[0];
  CHECK(effect.instance.effect->name == "torque_gain");
  CHECK(effect.joint == 2);  // joint 1 agrees with the masses of the URDF
  REQUIRE(effect.rivals.size() == 1);
  CHECK(effect.rivals[0].name == "torque_gain");
  CHECK(effect.rivals[0].joint == 1);
  CHECK(effect.evidence.p_value < 1e-6);
  // What is seen by joint 2 is no longer explained by other cables and masses than joint 1 has.
  const GapStory& gap = result.joints[1].torque;
  CHECK(gap.test_before > 5 * gap.test_after);
  CHECK(gap.test_after < 1.2 * gap.noise_floor);
}

}  // namespace
}  // namespace cablefit::test
