// A drive that holds its torque over a sample holds it in the blocked sweep too, where nothing but
// the moving logs shows it.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/identify/simulated_rigs.hpp"
#include "tests/support/plain_rigs.hpp"

namespace cablefit::test {
namespace {

constexpr double kPeriod = 1e-3;  // s
constexpr double kSpeed = 0.04;   // rad/s
constexpr double kPeak = 0.05;    // rad

/// A link held while its motor goes up and down at one speed. A row has the torque that acts from
/// its time on: on the mean that of half a row later.
std::string triangle_log(const PlainRig& rig, double seconds, unsigned seed) {
  PlainLog log(rig, seed);
  const std::vector<double> q{0.0}, load{0.0};
  const auto theta_at = [](double t) {
    const double turns = std::fmod(kSpeed * t / kPeak, 4);
    return kPeak * (turns < 1 ? turns : turns < 3 ? 2 - turns : turns - 4);
  };
  for (int i = 0; i < static_cast<int>(seconds / kPeriod); ++i) {
    const double t = i * kPeriod, acts = t + kPeriod / 2;
    const double speed = (theta_at(acts + 1e-6) - theta_at(acts - 1e-6)) / 2e-6;
    std::vector<double> tau = motor_torques(rig, q, {theta_at(acts)});
    tau[0] +=
        rig.joints[0].offset + rig.joints[0].f_sm * sign_of(speed) + rig.joints[0].f_vm * speed;
    log.add(t, q, {theta_at(t)}, tau, load);
  }
  return log.text();
}

}  // namespace

TEST_CASE("the hold that moving logs show holds in blocked sweeps too", "[identify][recover]") {
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.cables = {{"a", {round_map(0.03)}, {round_map(0.03)}, {2e5, 1e7}, 5e-4},
                {"b", {round_map(-0.03)}, {round_map(-0.03)}, {2e5, 1e7}, 5e-4}};
  const TempFolder folder;
  const Rig read = read_rig(folder.write("rig.json", rig_text(rig, "")));
  REQUIRE(read.torque_hold == TorqueHold::automatic);
  // The second preload was never moved: it has the drive of the first.
  const std::vector<LogSurvey> logs = {
      survey_file(folder.write("blocked.csv", triangle_log(rig, 40, 7)), read, "one"),
      survey_file(folder.write("moving.csv", moving_log(rig, 20, 8)), read, "one"),
      survey_file(folder.write("again.csv", triangle_log(rig, 40, 9)), read, "two")};
  const IdentifyResult result = identify(logs, {});
  REQUIRE(result.preloads.size() == 2);
  CHECK(result.preloads[0].delay.held);
  CHECK(result.preloads[0].delay.hold == Approx(kPeriod));
  // Without the hold they are larger by K kSpeed kPeriod / 2, about 0.005 N m.
  const double truth = rig.joints[0].f_sm + rig.joints[0].f_vm * kSpeed;
  for (const IdentifyPreload& preload : result.preloads) {
    const Estimate* friction = find_estimate(preload.parameters, "f_sm_blocked");
    if (friction == nullptr) friction = find_estimate(preload.parameters, "f_sm");
    REQUIRE(friction != nullptr);
    INFO(preload.name << ": " << friction->value << " +- " << friction->sd);
    CHECK(std::abs(friction->value - truth) < 3 * friction->sd);
    CHECK(friction->sd < 1e-3);
  }
}

}  // namespace cablefit::test
