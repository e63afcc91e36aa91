// A blocked sweep that is slower than any motion of the moving logs.
#include <catch2/catch.hpp>

#include "cablefit/session/stages.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace cablefit::test {
namespace {

TEST_CASE("a slow blocked sweep beside fast logs is used", "[refine]") {
  PlainRig rig = four_cable_finger();
  rig.joints.resize(1);
  rig.cables.resize(2);
  for (PlainCable& cable : rig.cables) {
    cable.motor.resize(1);
    cable.link.resize(1);
  }
  // Hz: at most 0.008 rad/s. Of the moving logs' 1 rad/s, 2 % would count as standing still.
  rig.joints[0].sweep_rate = 0.004;
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  RefineLogs logs;
  logs.blocked = {bench.add_text(blocked_log(rig, {0.1}, 300, 31, 50, 0, 0.02))};
  logs.train = {bench.add_text(moving_log(rig, 12, 32))};
  RefineOptions options;
  options.n_draws = 4;
  const RefineResult result = missing_effects(logs, options);
  CHECK(result.verdict == Verdict::none);
  bool any = false;
  for (const EquationRemainder& remainder : result.remainders)
    any = any || (remainder.equation == "blocked" && remainder.noise > 0);
  CHECK(any);  // the sweep has rows
}

}  // namespace
}  // namespace cablefit::test
