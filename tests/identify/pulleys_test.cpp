// Cases in which theta - q does not determine the elongation of cables: pulleys of two radii on a
// link that moves, and a cam whose radius is 0 in the reference pose.
#include "cablefit/identify/identify.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Cables of 3 cm on the motor and 5 cm on the link that soften and would push beyond 10 mm. The
/// motor runs through 0.4 rad more than the link, which is 12 mm; the cables stretch by 4 mm.
PlainRig softening_cables(double l_o) {
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.joints[0].sweep = 0.12;
  rig.joints[0].swing = 1.2;
  rig.cables = {{"flexor", {round_map(0.03)}, {round_map(0.05)}, {2e5, -2e7}, l_o},
                {"extensor", {round_map(-0.03)}, {round_map(-0.05)}, {2e5, -2e7}, l_o}};
  return rig;
}

IdentifyResult identified(const PlainRig& rig, ElongationMode elongations) {
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  bench.add_text(blocked_log(rig, {0}, 100, 81));
  bench.add_text(moving_log(rig, 20, 82));
  IdentifyOptions options;
  options.elongations = elongations;
  return identify(bench.logs(), options);
}

void check_softening(const IdentifyResult& r) {
  const IdentifyPreload& p = r.preloads.at(0);
  check_recovered(r.parameters,
                  {{"k[flexor]_0", 2e5},
                   {"k[flexor]_1", -2e7},
                   {"k[extensor]_0", 2e5},
                   {"k[extensor]_1", -2e7},
                   {"J_link", 0.05},
                   {"J_motor", 0.005}},
                  3);
  CHECK(r.active_bounds.empty());
  for (const ElongationRange& range : p.elongations) CHECK(range.high < 6e-3);
  // With the link held, elongations of +-6 mm are deflections of +-0.2 rad on 3 cm.
  CHECK(p.deflection_high < 0.2);
  CHECK(p.deflection_low > -0.2);
}

TEST_CASE("cables are not bounded beyond where they are stretched", "[identify][recover]") {
  check_softening(identified(softening_cables(0), ElongationMode::known));
}

TEST_CASE("l_o is found with pulleys of two radii", "[identify][recover]") {
  const IdentifyResult r = identified(softening_cables(1e-3), ElongationMode::search);
  check_softening(r);
  check_recovered(r.preloads.at(0).parameters, {{"l_o[flexor]", 1e-3}, {"l_o[extensor]", 1e-3}}, 3);
}

// The cam's radius is 0.5 m/rad times the angle: 0 in the reference pose, 15 cm at 0.3 rad.
TEST_CASE("l_o is found on a cam that has no radius in the reference pose", "[identify][recover]") {
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.joints[0].sweep = 0.02;
  rig.quantum = 1e-6;  // steps of the encoder are errors of the regressors, which no sd knows of
  rig.cables = {{"a", {round_map(0.05)}, {round_map(0.05)}, {2e5}, 2e-4},
                {"b", {round_map(-0.05)}, {round_map(-0.05)}, {2e5}, 2e-4},
                {"c", {{{0, 0.5}}}, {{{0, 0.5}}}, {1e5}, 3e-4}};
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  bench.add_text(blocked_log(rig, {0.3}, 60, 83));
  bench.add_text(blocked_log(rig, {-0.2}, 60, 84));
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  const IdentifyResult r = identify(bench.logs(), options);
  check_recovered(r.parameters, {{"k[a]_0", 2e5}, {"k[b]_0", 2e5}, {"k[c]_0", 1e5}}, 3);
  check_recovered(r.preloads.at(0).parameters,
                  {{"l_o[a]", 2e-4}, {"l_o[b]", 2e-4}, {"l_o[c]", 3e-4}}, 3.3);  // one is at 3.00
  for (const ElongationProfile& profile : r.profiles)
    for (const double deviance : profile.deviance) CHECK(deviance > -0.1);
}

}  // namespace
