// A finger whose distal cables pass the proximal joint and are wound by another motor: where they
// are always taut, the proximal joint's own logs do not separate their coefficients. The blocked
// log is slower than the drive, as an export of every tenth row is.
#include <catch2/catch.hpp>

#include "cablefit/session/stages.hpp"
#include "tests/hidden/joints/joint_effects.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace cablefit::test {
namespace {

constexpr double kDrive = 1e-3;  // s, of moving_log

struct Pairs {
  Bench bench;
  RefineResult result;

  /// `hold`: s, of the drive in the blocked log of 100 Hz.
  explicit Pairs(const PlainRig& hidden, double hold) {
    bench.rig = read_rig(bench.folder().write("rig.json", rig_text(four_cable_finger(), "")));
    RefineLogs logs;
    logs.blocked = {bench.add_text(blocked_log(hidden, {0, 0}, 50, 3, 100, 0, hold))};
    logs.train = {bench.add_text(moving_log(hidden, 12, 4))};
    RefineOptions options;
    options.n_draws = 6;
    result = missing_effects(logs, options);
  }

  std::string hold_of_blocked() const {
    for (const Decision& decision : result.decisions)
      if (decision.name == "blocked: torque hold") return decision.value;
    return "";
  }
};

const Cable& cable_of(const Model& model, const std::string& name) {
  for (const Cable& cable : model.transmission.cables)
    if (cable.name == name) return cable;
  FAIL("no cable " << name);
  return model.transmission.cables.front();
}

}  // namespace

// The stiffness halves where a cable goes slack: so a blocked log shows how late its torque is.
TEST_CASE("cables that only another joint's logs separate do not stop refine", "[refine]") {
  const Pairs pairs(four_cable_finger(), kDrive);
  CHECK(pairs.hold_of_blocked() == "zoh, 1 ms");
  CHECK(pairs.result.verdict == Verdict::none);
  REQUIRE(pairs.result.joints.size() == 2);
  for (const RefineResult& joint : pairs.result.joints) {
    CHECK(joint.not_refined == "");
    CHECK(joint.verdict == Verdict::none);
  }
  CHECK(pairs.result.joints[0].warnings ==
        std::vector<std::string>{
            "the logs do not separate the stiffness of pip, dip: the values of the joints whose "
            "motors wind them are used; move until one goes slack"});
  // All cables of the joined model are those of the simulation, wherever they were fitted.
  const PlainRig truth = four_cable_finger();
  for (const PlainCable& cable : truth.cables)
    CHECK(cable_of(pairs.result.models.at(0), cable.name).coefficients.at(0) ==
          Approx(cable.k.at(0)).epsilon(0.01));
}

TEST_CASE("an effect is named on its joint where distal cables pass the other", "[refine]") {
  for (const std::size_t joint : {0u, 1u}) {
    INFO("joint " << joint + 1);
    PlainRig hidden = four_cable_finger();
    find_joint_effect("stribeck", "motor").hide(hidden, joint, 1);
    const Pairs pairs(hidden, kDrive);
    CHECK(pairs.hold_of_blocked() == "zoh, 1 ms");
    CHECK(pairs.result.verdict != Verdict::unexplained);
    REQUIRE(pairs.result.effects.size() == 1);
    CHECK(pairs.result.effects[0].instance.effect->name == "stribeck");
    CHECK(pairs.result.effects[0].joint == static_cast<int>(joint) + 1);
    CHECK(pairs.result.joints.at(1 - joint).verdict == Verdict::none);
  }
}

TEST_CASE("a blocked log of a slower drive keeps its own hold", "[refine]") {
  const Pairs slow(four_cable_finger(), 0.01);
  CHECK(slow.hold_of_blocked() == "");
  CHECK(slow.result.verdict == Verdict::none);
}

}  // namespace cablefit::test
