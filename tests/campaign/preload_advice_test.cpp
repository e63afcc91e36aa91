// The trade-off between preloads on the shipped logs.
#include "cablefit/campaign/preload_advice.hpp"

#include <catch2/catch.hpp>

#include "cablefit/design/collision.hpp"

namespace cablefit {
namespace {

const BatchResult& shipped() {
  static const BatchResult result = run_batch(read_campaign(CABLEFIT_DATA "/campaign.json"), {});
  return result;
}

TEST_CASE("a preload costs friction and keeps a straight line honest", "[campaign]") {
  const std::vector<PreloadAdvice> advice = preload_advice(shipped().cells, {});
  REQUIRE(advice.size() == 2);
  const PreloadAdvice &low = advice[0], &high = advice[1];
  CHECK(low.cell == "low");
  // Table 2 of the paper, whose frictions the shipped logs were simulated with.
  CHECK(low.friction == Approx(3.273 + 2.778).epsilon(0.01));
  CHECK(high.friction == Approx(7.037 + 3.6).epsilon(0.01));
  CHECK(low.linear_error > 10 * low.model_error);
  CHECK(low.collision_linear > 5 * low.collision_model);
  CHECK(std::isnan(low.closure_low));  // no l_o in the rig file
}

// Worst of both signs: threshold e + z_fa s, found when -e + torque passes it, 2 e + (z_fa + z_d)
// s.
TEST_CASE("the smallest collision follows from error and noise", "[campaign]") {
  const AdviceDetector detector;
  const PreloadAdvice low = preload_advice(shipped().cells, detector).front();
  CollisionDetector same;
  const DynamicPreload& stage2 = shipped().cells[0].dynamic->preloads[0];
  for (const JudgedEquation& e : stage2.residual_tests)
    if (e.model == "poly" && e.equation == "link") same.mean_noise = sd_of_mean(e.means, 0.05);
  REQUIRE(same.mean_noise.has_value());
  CHECK(*same.mean_noise < stage2.fits.back().torque_error.at("link").rms);
  same.model_error = low.linear_error;
  same.false_alarm_rate = 1 / (3600 / 0.05);
  same.detection_rate = 0.99;
  CHECK(low.collision_linear == Approx(collision_threshold(same).torque));
  // z(1 - 1/72000) = 4.19, z(.99) = 2.33 (R: qnorm).
  CHECK(low.collision_linear ==
        Approx(2 * low.linear_error + 6.52 * *same.mean_noise).epsilon(1e-3));
}

}  // namespace
}  // namespace cablefit
