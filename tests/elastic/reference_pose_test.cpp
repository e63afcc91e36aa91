// Blocked far from zero: what cables are stretched counts from the reference pose, not from
// theta = q.
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kLink = 1;  // rad, where the link is held

/// Motor radius, reference pose of the motor, and the cables' l = 0 there.
PlainRig stiffening_pair(double motor_radius, double link_radius, double theta) {
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  const double shift = link_radius * kLink - motor_radius * theta;
  rig.cables = {{"a", {round_map(motor_radius)}, {round_map(link_radius)}, {2e5, 4e7}, shift},
                {"b", {round_map(-motor_radius)}, {round_map(-link_radius)}, {2e5, 4e7}, -shift}};
  return rig;
}

ElasticPreload fitted(const PlainRig& rig, double theta, int order) {
  PlainRig told = rig;
  for (PlainCable& cable : told.cables) cable.l_o = 0;
  Bench bench;
  bench.rig = read_rig(bench.folder().write(
      "rig.json", rig_text(told, fmt::format(R"( "reference_pose": {{"q": [{}], "theta": [{}]}},)",
                                             kLink, theta))));
  bench.add_text(blocked_log(rig, {kLink}, 60, 91, 200, theta - kLink));
  ElasticOptions options;
  options.order = order;
  return fit_elastic(bench.logs(), options).preloads.at(0);
}

TEST_CASE("cables of a link held elsewhere are taut as the reference pose says", "[elastic]") {
  const double theta = 2;
  const PlainRig rig = stiffening_pair(0.03, 0.06, theta);
  const ElasticPreload preload = fitted(rig, theta, 2);
  const ElasticFit& poly = *preload.find("poly");
  check_recovered(poly.parameters,
                  {{"k[a]_0", 2e5}, {"k[a]_1", 4e7}, {"k[b]_0", 2e5}, {"k[b]_1", 4e7}}, 3);
  for (const auto* warnings : {&preload.warnings, &poly.warnings})
    for (const std::string& warning : *warnings) {
      INFO(warning);
      CHECK(warning.find("never taut") == std::string::npos);
    }
}

// The same torques 0.2 rad away: 6e5 N/m^2 of curvature make the straight line wrong by more than
// a percent of the peak either way.
TEST_CASE("the choice of a model does not depend on where theta is zero", "[elastic]") {
  const ElasticPreload centred = fitted(stiffening_pair(0.03, 0.03, kLink), kLink, 2);
  const ElasticPreload shifted = fitted(stiffening_pair(0.03, 0.03, kLink + 0.7), kLink + 0.7, 2);
  CHECK(centred.selected == "poly");
  CHECK(shifted.selected == "poly");
  // Within the noise of the torque, 0.05 N m.
  CHECK(std::abs(shifted.peak_torque - centred.peak_torque) < 0.3);
}

}  // namespace
