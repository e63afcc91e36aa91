// Blocked logs alone: what stage 1 lacks is named, nothing is named where nothing is missing.
#include <catch2/catch.hpp>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/refine.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

/// The blocked run of a full design, and the model as stage 1 knows it.
HiddenLogs blocked_only(const std::vector<std::string>& effects, unsigned long seed) {
  HiddenLogs hidden = hidden_logs(effects, seed, "full");
  hidden.logs.train.clear();
  hidden.logs.test.clear();
  for (Model& model : hidden.models) {
    model.joints.front().link.clear();
    model.joints.front().motor.clear();
  }
  return hidden;
}

RefineResult refined(const HiddenLogs& hidden) {
  RefineOptions options;
  options.n_draws = 12;
  options.threads = 2;
  return refine(hidden.models, hidden.logs, options);
}

std::string first_name(const RefineResult& result) {
  return result.effects.empty() ? "" : std::string(result.effects.front().instance.effect->name);
}

}  // namespace

TEST_CASE("blocked logs without an effect have none", "[refine][elastic-stage]") {
  for (const unsigned long seed : {1UL, 2UL, 3UL}) {
    const RefineResult result = refined(blocked_only({}, seed));
    INFO("seed " << seed << ": " << first_name(result) << ", " << result.reason);
    CHECK(result.verdict == Verdict::none);
    CHECK(result.elastic_only);
    // Some 300 rows of 20 s under wide kernels: rho scatters by sqrt(2 / 300) = 8 %, its floor by
    // half of that; three times both.
    CHECK(result.rho_before == Approx(1).margin(0.28));
    CHECK_FALSE(result.simulation.known);
    CHECK(result.held_out_blocks);
  }
}

TEST_CASE("what stage 1 lacks is named from blocked logs alone", "[refine][elastic-stage]") {
  struct Case {
    std::string planted, name;
  };
  const Case cases[] = {{"cable_hysteresis.transmission=1", "cable_hysteresis"},
                        {"creep.transmission=2", "creep"},
                        {"dead_zone.transmission=1", "dead_zone"},
                        {"stiffness_order.transmission=1", "stiffness_order"}};
  for (const Case& one : cases) {
    const RefineResult result = refined(blocked_only({one.planted}, 1));
    INFO(one.planted << ": " << first_name(result) << ", " << result.reason);
    CHECK(first_name(result) == one.name);
    const double floor = result.torque.noise_floor;
    const auto above = [&](double rms) { return rms * rms - floor * floor; };
    CHECK(above(result.torque.test_after) < 0.3 * above(result.torque.test_before));
    CHECK(result.rho_after - 1 < 0.05 * (result.rho_before - 1));
  }
}

/// Homed anew before the second log.
TEST_CASE("an encoder zero that moved between two blocked logs is a slip",
          "[refine][elastic-stage]") {
  HiddenLogs hidden = blocked_only({}, 1);
  const HiddenLogs other = blocked_only({"encoder_offset.sensor=1"}, 1);
  const double shift = other.truth.effects.at(0).coefficients.at(0).value;
  hidden.logs.blocked.push_back(other.logs.blocked.at(0));
  const RefineResult result = refined(hidden);
  INFO(result.reason);
  REQUIRE(first_name(result) == "slip");
  const EffectInstance& slip = result.effects[0].instance;
  CHECK(slip.event_log == 1);
  CHECK(slip.event_time == 0);
  CHECK(std::abs(slip.parameters.at(0).value) == Approx(std::abs(shift)).epsilon(0.03));
  CHECK(result.effects.size() == 1);
  CHECK(result.rho_after - 1 < 0.01 * (result.rho_before - 1));
}

TEST_CASE("blocked logs name nothing of what they cannot show", "[refine][elastic-stage]") {
  const RefineResult result = refined(blocked_only({"cable_hysteresis.transmission=1"}, 2));
  for (const Rival& row : result.ranking) {
    INFO(row.name << " " << row.side);
    CHECK(row.side != "link");
    CHECK(row.name != "presliding");  // of the motor: the same law on a blocked link
  }
}

/// What came before a held-out third is its history: hysteresis does not begin anew there.
TEST_CASE("the held-out third of a blocked log knows its history", "[refine][elastic-stage]") {
  const HiddenLogs hidden = blocked_only({}, 1);
  std::vector<Stretch> train =
      read_stretches(hidden.logs.blocked, hidden.models, [](const PartSurvey&) { return true; });
  const Eigen::Index n = train.front().recording.theta.size();
  const std::vector<Stretch> test = hold_out(train, 0.25, HoldOut::all);
  REQUIRE(test.size() == train.size());
  CHECK(test.front().recording.theta.size() == n);
  CHECK(test.front().rows_from == train.front().recording.theta.size());
  const Smoothing smoothing = blocked_smoothing(hidden.models, train);
  const Design design = make_design(hidden.models, test, smoothing);
  REQUIRE_FALSE(design.rows.front().kinds.front().at.empty());
  for (const Eigen::Index at : design.rows.front().kinds.front().at)
    CHECK(at >= test.front().rows_from);
}

TEST_CASE("stage 1's model needs a blocked log", "[refine][elastic-stage]") {
  HiddenLogs hidden = hidden_logs({});
  hidden.models.front().joints.front().link.clear();
  hidden.logs.blocked.clear();
  CHECK_THROWS_WITH(stage_of(hidden.models, hidden.logs),
                    Catch::Contains("no log with the link blocked") &&
                        Catch::Contains("'cablefit dynamic' or 'identify'"));
}
