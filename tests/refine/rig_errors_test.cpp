// Several values of one rig file that are wrong.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "cablefit/refine/rig_errors/rig_error.hpp"
#include "cablefit/report/sections/refine_story.hpp"
#include "tests/refine/refined_finger.hpp"

namespace cablefit::test {
namespace {

/// Right radius of each pulley that is named: "motor[flexor], joint 1".
std::map<std::string, Estimate> radii_of(const RefineResult& result) {
  std::map<std::string, Estimate> radii;
  for (const NamedEffect& effect : result.effects) {
    if (effect.instance.effect->name != "cable_radius") continue;
    const Estimate& radius = effect.instance.parameters.at(0);
    radii[fmt::format("{} {}, joint {}", to_string(effect.instance.effect->site), radius.name,
                      effect.joint)] = radius;
  }
  return radii;
}

void check_value(const Estimate& e, double right) {
  INFO(e.name << " = " << e.value << " +- " << e.sd << ", right: " << right);
  CHECK(std::abs(e.value - right) < 4 * e.sd);
  CHECK(e.sd < 1e-3 * 0.01);
}

/// These radii and nothing else are named.
void check_radii(const RefineResult& result, const std::map<std::string, double>& right) {
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == right.size());
  const auto radii = radii_of(result);
  for (const auto& [name, radius] : right) {
    INFO(name);
    REQUIRE(radii.count(name) == 1);
    check_value(radii.at(name), radius);
  }
}

void check_no_gap(const RefineResult& result) {
  for (const RefineResult& joint : result.joints) {
    CHECK(joint.not_refined.empty());
    CHECK(joint.torque.test_after < 1.1 * joint.torque.noise_floor);
  }
}

RefineResult joint(double rho_before, double rho_after, std::size_t n_effects) {
  RefineResult r;
  r.rho_before = rho_before;
  r.rho_after = rho_after;
  r.effects.resize(n_effects);
  return r;
}

TEST_CASE("right values are the answer where they explain what effects do", "[refine]") {
  const std::vector<RefineResult> by_effects{joint(100, 1, 1), joint(1, 1, 0)};
  const std::vector<RefineResult> left_open{joint(100, 40, 1), joint(50, 30, 1)};
  const std::vector<RefineResult> right{joint(1, 1, 0), joint(1, 1, 0)};
  CHECK(is_explained(by_effects, right, 1));
  // Two values fit more than one effect.
  CHECK_FALSE(may_explain(by_effects, 2));
  CHECK_FALSE(is_explained(by_effects, right, 2));
  CHECK(may_explain(left_open, 3));
  CHECK(is_explained(left_open, right, 3));
  // A joint that they change is left with more than the noise.
  CHECK_FALSE(is_explained(left_open, {joint(1, 1, 0), joint(3, 3, 0)}, 1));
  CHECK_FALSE(is_explained(left_open, {joint(110, 60, 0), joint(1, 1, 0)}, 1));
  // A joint that they do not change stays as it is.
  CHECK(is_explained({joint(100, 40, 1), joint(50, 30, 1)}, {joint(1, 1, 0), joint(50, 30, 1)}, 1));
}

TEST_CASE("right values with which a joint can be refined are the answer", "[refine]") {
  RefineResult refused;
  refused.not_refined = "the simulated loop diverged";
  const std::vector<RefineResult> given{refused, joint(1, 1, 0)};
  CHECK(is_explained(given, {joint(1, 1, 0), joint(1, 1, 0)}, 2));
  CHECK_FALSE(is_explained(given, {refused, joint(1, 1, 0)}, 2));
  CHECK_FALSE(is_explained(given, {joint(1, 1, 0), refused}, 2));
  RefineResult unexplained = joint(9, 9, 0);
  unexplained.verdict = Verdict::unexplained;
  CHECK_FALSE(is_explained(given, {unexplained, joint(1, 1, 0)}, 2));
}

TEST_CASE("two wrong radii are identified together", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[1].link[1] = round_map(-0.0093);  // -0.009 in the rig file
  hidden.cables[0].motor[0] = round_map(0.0102);
  const RefineResult result = refined(hidden).result;
  check_radii(result, {{"link radius[extensor], joint 2", -0.0093},
                       {"motor radius[flexor], joint 1", 0.0102}});
  check_no_gap(result);
}

TEST_CASE("a wrong radius is identified on a base that leans", "[refine]") {
  PlainRig hidden = phalanges_rig();
  PlainArm& arm = *hidden.link_dynamics.target<PlainArm>();
  arm.gravity = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) * arm.gravity;
  hidden.cables[1].link[1] = round_map(1.03 * hidden.cables[1].link[1].radius[0]);
  const RefineResult result = refined_arm(hidden).result;
  CHECK(result.verdict == Verdict::named);
  REQUIRE(result.effects.size() == 2);
  for (const NamedEffect& effect : result.effects) CHECK(effect.rivals.empty());
  const auto radii = radii_of(result);
  REQUIRE(radii.count("link radius[extensor], joint 2") == 1);
  check_value(radii.at("link radius[extensor], joint 2"), hidden.cables[1].link[1].radius[0]);
  const auto gravity = std::find_if(
      result.effects.begin(), result.effects.end(),
      [](const NamedEffect& e) { return e.instance.effect->name == "gravity_direction"; });
  REQUIRE(gravity != result.effects.end());
  for (std::size_t k = 0; k < 3; ++k) {
    const Estimate& e = gravity->instance.parameters.at(k);
    INFO(e.name << " = " << e.value);
    CHECK(std::abs(e.value - arm.gravity(static_cast<Eigen::Index>(k))) < 0.02);
  }
  check_no_gap(result);
}

TEST_CASE("radii of one joint that are wrong together are identified", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[0].link[1] = round_map(0.0072);  // 0.007 in the rig file
  hidden.cables[1].link[1] = round_map(-0.0093);
  const RefineResult result = refined(hidden).result;
  check_radii(result, {{"link radius[flexor], joint 2", 0.0072},
                       {"link radius[extensor], joint 2", -0.0093}});
  check_no_gap(result);
  std::set<std::string> labels;
  for (const NamedEffect& effect : result.effects) labels.insert(effect_text(effect, result));
  CHECK(labels ==
        std::set<std::string>{"cable_radius[flexor] (link 2)", "cable_radius[extensor] (link 2)"});
}

TEST_CASE("three radii that are wrong together are identified", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[0].link[1] = round_map(0.0071);
  hidden.cables[0].motor[0] = round_map(0.0102);
  hidden.cables[1].link[1] = round_map(-0.0093);
  const RefineResult result = refined(hidden).result;
  check_radii(result, {{"link radius[flexor], joint 2", 0.0071},
                       {"motor radius[flexor], joint 1", 0.0102},
                       {"link radius[extensor], joint 2", -0.0093}});
  check_no_gap(result);
}

/// Three of them take the place of all, as far as they can: their values would be wrong.
TEST_CASE("of more wrong radii than are searched none is named", "[refine]") {
  PlainRig hidden = tendon_finger();
  hidden.cables[0].link[1] = round_map(0.0072);
  hidden.cables[0].motor[0] = round_map(0.0103);
  hidden.cables[1].link[0] = round_map(0.97 * hidden.cables[1].link[0].radius[0]);
  hidden.cables[1].link[1] = round_map(-0.0093);
  const RefineResult result = refined(hidden).result;
  CHECK(result.verdict != Verdict::none);
  CHECK(radii_of(result).empty());
  CHECK(std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& text) {
    return text.find("the rig file may be wrong in more than one value: cable_radius[") !=
           std::string::npos;
  }));
}

}  // namespace
}  // namespace cablefit::test
