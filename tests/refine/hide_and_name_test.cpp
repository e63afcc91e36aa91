// Effects hidden by the second simulator are found, named and added; where nothing is hidden,
// nothing is named. A reduced form of tests/hidden/run, through the library.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/refine/refine.hpp"
#include "cablefit/refine/steps/effect_trial.hpp"
#include "cablefit/session/stages.hpp"
#include "tests/refine/hidden_logs.hpp"
#include "tests/support/monte_carlo.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

RefineResult refined(const HiddenLogs& hidden, int threads = 2) {
  RefineOptions options;
  options.n_draws = 8;
  options.threads = threads;
  return refine(hidden.models, hidden.logs, options);
}

std::string first_name(const RefineResult& result) {
  return result.effects.empty() ? "" : std::string(result.effects.front().instance.effect->name);
}

const Estimate& parameter(const RefineResult& result, std::string_view name) {
  const NamedEffect& effect = result.effects.at(0);
  const Estimate* own = find_estimate(effect.instance.parameters, name);
  const Estimate* derived = find_estimate(effect.derived, name);
  REQUIRE((own != nullptr || derived != nullptr));
  return own != nullptr ? *own : *derived;
}

double truth(const HiddenLogs& hidden, std::string_view name) {
  for (const hidden::Coefficient& c : hidden.truth.effects.at(0).coefficients)
    if (c.name == name) return c.value;
  FAIL("no coefficient " << name);
  return 0;
}

/// These two are named, in this order, and leave at most this many squared floors.
void check_two(const RefineResult& result, std::string_view first, std::string_view second,
               double most_rho) {
  INFO(result.reason);
  REQUIRE(result.effects.size() == 2);
  CHECK(first_name(result) == first);
  CHECK(result.effects[1].instance.effect->name == second);
  CHECK(result.rho_after < most_rho);
}

}  // namespace

TEST_CASE("nothing hidden: nothing named", "[refine][slow]") {
  const RefineResult result = refined(hidden_logs({}));
  INFO(result.reason);
  CHECK(result.verdict == Verdict::none);
  CHECK(result.effects.empty());
  // Floors of four draws scatter by some per cent.
  CHECK(result.rho_before == Approx(1).margin(0.1));
  CHECK(result.ranking.size() > 20);
}

TEST_CASE("what is smaller than the size that was asked for is not named", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"stribeck.motor=0.3"});
  RefineOptions options;
  options.n_draws = 8;
  options.threads = 2;
  REQUIRE(first_name(refine(hidden.models, hidden.logs, options)) == "stribeck");
  options.material = 1000;
  const RefineResult result = refine(hidden.models, hidden.logs, options);
  CHECK(result.effects.empty());
  CHECK(result.verdict == Verdict::none);
  CHECK(result.reason.find("too small to matter") != std::string::npos);
}

/// An axis that is homed before each log has slipped in one of them only.
TEST_CASE("a slip that ends with its log is named and sized", "[refine][slow]") {
  HiddenLogs hidden = hidden_logs({"slip.transmission=1"}, 2);
  const HiddenLogs nothing = hidden_logs({}, 2);
  std::vector<LogSurvey>& train = hidden.logs.train;
  const auto differ = [](const LogSurvey& a, const LogSurvey& b) {
    return !std::equal(a.parts[0].channels.begin(), a.parts[0].channels.end(),
                       b.parts[0].channels.begin(), [](const auto& x, const auto& y) {
                         return x.min == y.min && x.max == y.max && x.noise == y.noise;
                       });
  };
  std::size_t slipped = 0;
  while (slipped < train.size() && !differ(train[slipped], nothing.logs.train[slipped])) ++slipped;
  REQUIRE(slipped + 1 < train.size());
  for (std::size_t k = slipped + 1; k < train.size(); ++k) train[k] = nothing.logs.train[k];
  hidden.logs.test = nothing.logs.test;
  const RefineResult result = refined(hidden);
  INFO(result.reason);
  REQUIRE(first_name(result) == "slip");
  CHECK(result.effects[0].instance.ends_with_log);
  CHECK(result.effects[0].instance.event_log == hidden.logs.blocked.size() + slipped);
  CHECK(parameter(result, "slip").value == Approx(truth(hidden, "slip")).epsilon(0.05));
  CHECK(result.rho_after < 1.2);
  CHECK(result.models[0].joints[0].added.empty());  // over with the log
}

TEST_CASE("a hidden Stribeck friction is named, sized and closes the gap", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"stribeck.motor=1"});
  const RefineResult result = refined(hidden);
  INFO(result.reason);
  REQUIRE(first_name(result) == "stribeck");
  CHECK(result.effects[0].instance.effect->site == Site::motor);
  CHECK(result.effects[0].evidence.p_value <= 0.01);
  const Estimate& amplitude = parameter(result, "amplitude");
  CHECK(std::abs(amplitude.value - truth(hidden, "amplitude")) <
        4 * amplitude.sd + 0.05 * amplitude.value);
  CHECK(amplitude.sd > 0.002 * amplitude.value);
  CHECK(amplitude.sd < 0.1 * amplitude.value);
  CHECK(result.rho_after < 1.2);
  CHECK(result.torque.test_after < result.torque.test_before);
  CHECK(result.simulation.test_after < result.simulation.test_before);
}

/// Within 3 sd, which is no excuse: below a tenth.
void check_near(const Estimate& found, double true_value) {
  INFO(found.name << " = " << found.value << " +- " << found.sd << ", true " << true_value);
  CHECK(std::abs(found.value - true_value) < 3 * found.sd);
  CHECK(found.sd < 0.1 * true_value);
}

/// What is said of logs with this effect, which has to be named.
RefineResult named(const HiddenLogs& hidden, std::string_view effect) {
  RefineResult result = refined(hidden);
  INFO(result.reason);
  REQUIRE(first_name(result) == effect);
  return result;
}

/// Of the cable's loops the smoothed motion shows less than the cable has: a fit alone puts the
/// yield a quarter low.
TEST_CASE("the yield of a hidden hysteresis has no bias", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"cable_hysteresis.transmission=0.3"});
  const RefineResult result = named(hidden, "cable_hysteresis");
  for (const char* name : {"amplitude", "yield"})
    check_near(parameter(result, name), truth(hidden, name));
}

/// What a delay of 1.5 ms changes is not 15 times what a tenth of a millisecond does: linearised at
/// zero it was found 5 to 13 % too short, and J_link 0.5 % off.
TEST_CASE("a long delay of an encoder is found whole", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"encoder_delay.sensor=1"});
  const RefineResult result = named(hidden, "encoder_delay");
  CHECK(parameter(result, "delay").value == Approx(truth(hidden, "delay")).epsilon(0.01));
  const std::vector<Estimate>& j = result.models.at(0).joints.at(0).link.at(0).parameters;
  CHECK(j.at(0).value == Approx(hidden.truth.bench.rig.J_link).epsilon(0.002));
}

/// Its cable 1 is taut in 22 of 40000 samples. As a cable of order 1 it hid the gravity, and moved
/// J_link, the friction and the other cable by 5 to 9 sd.
TEST_CASE("a cable that is seldom taut decides nothing", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"gravity_imbalance.link=1"}, 28, "one_load");
  RefineOptions options;
  options.n_draws = 6;
  const RefineResult result = missing_effects(hidden.logs, options);
  INFO(result.reason);
  REQUIRE(first_name(result) == "gravity_imbalance");
  const Transmission& transmission = result.models.at(0).transmission;
  REQUIRE(transmission.cables.size() == 1);
  CHECK(transmission.cables[0].name == "2");
  CHECK(std::any_of(result.decisions.begin(), result.decisions.end(), [](const Decision& d) {
    return d.name == "cables" && d.value == "no cable 1";
  }));
}

/// Between two dates half a second apart it was missed, or found twice as long.
TEST_CASE("a short contact is as long as it was", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"contact.link=1"});
  const RefineResult result = named(hidden, "contact");
  for (const char* name : {"torque", "width"}) {
    INFO(name << " sd " << parameter(result, name).sd);
    CHECK(parameter(result, name).value == Approx(truth(hidden, name)).epsilon(0.1));
  }
  CHECK(result.effects[0].instance.event_time == Approx(truth(hidden, "t0")).margin(0.05));
}

/// The second simulator runs for half a second before it logs.
TEST_CASE("a hidden creep has begun before the log", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"creep.transmission=1"});
  const RefineResult result = named(hidden, "creep");
  for (const char* name : {"compliance", "T"})
    check_near(parameter(result, name), truth(hidden, name));
  const Estimate& settled = parameter(result, "settled");
  CHECK(std::abs(settled.value - (1 - std::exp(-0.5 / truth(hidden, "T")))) < 3 * settled.sd);
  CHECK(settled.sd < 0.1);
}

/// Filters and rounding bias a fit by equation error by tens of its sd (K1_0 by 0.3 %): its
/// equations leave no more than noise, its simulation of the test logs does. Without the correction
/// the gap is 1.11 to 1.14 floors in these two.
TEST_CASE("what was found simulates test logs down to the noise", "[refine][slow]") {
  for (const std::string effect : {"quadratic_drag.link=0.5", "presliding.link=0.3"}) {
    const RefineResult result = refined(hidden_logs({effect}, 2));
    INFO(effect << ": " << result.reason);
    REQUIRE(result.effects.size() == 1);
    CHECK(result.simulation.test_before > 1.5 * result.simulation.noise_floor);
    CHECK(result.simulation.test_after < 1.06 * result.simulation.noise_floor);
  }
}

TEST_CASE("a refinement has the same bits for any number of threads", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"cogging.motor=1"});
  const RefineResult one = refined(hidden, 1), three = refined(hidden, 3);
  REQUIRE(first_name(one) == "cogging");
  REQUIRE(first_name(three) == "cogging");
  const auto& a = one.effects[0].instance.parameters;
  const auto& b = three.effects[0].instance.parameters;
  for (std::size_t k = 0; k < a.size(); ++k) {
    CHECK(a[k].value == b[k].value);
    // What the plain form leaves out has none.
    CHECK((a[k].sd == b[k].sd || (std::isnan(a[k].sd) && std::isnan(b[k].sd))));
  }
  CHECK(one.rho_after == three.rho_after);
  CHECK(one.simulation.test_after == three.simulation.test_after);
  CHECK(one.effects[0].evidence.p_value == three.effects[0].evidence.p_value);
}

TEST_CASE("a low-frequency disturbance is unexplained", "[refine][slow]") {
  const RefineResult result = refined(hidden_logs({}, 2, "short", 0.1));
  INFO(first_name(result));
  CHECK(result.verdict == Verdict::unexplained);
  REQUIRE(result.unexplained);
  CHECK(result.unexplained->kind == "wandering");
}

TEST_CASE("what is not in the catalogue is unexplained", "[refine][slow]") {
  const RefineResult result = refined(hidden_logs({"attached_mode.link=1"}));
  INFO(first_name(result));
  CHECK(result.verdict == Verdict::unexplained);
  CHECK(result.remainder_link > result.floor_link);
}

TEST_CASE("two effects at once are judged together", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"drive_dead_band.drive=0.2254", "presliding.link=0.1073"});
  check_two(refined(hidden), "drive_dead_band", "presliding", 1.2);
}

/// Together they look like a torque constant that is off, which beside a dead band is best as well.
TEST_CASE("two effects that look like a third are named", "[refine][slow]") {
  const HiddenLogs hidden =
      hidden_logs({"drive_efficiency.motor=0.1337", "drive_dead_band.drive=0.2093"}, 2);
  check_two(refined(hidden), "drive_efficiency", "drive_dead_band", 1.1);
}

/// The same of longer runs, in which the third effect is identified alone and leaves a residual. It
/// takes half a minute and runs with CABLEFIT_MONTE_CARLO=full only.
TEST_CASE("two effects behind one name are found", "[refine][slow]") {
  if (!full_monte_carlo()) {
    WARN("skipped: CABLEFIT_MONTE_CARLO is not full");
    return;
  }
  const HiddenLogs hidden =
      hidden_logs({"drive_efficiency.motor=0.1481", "drive_dead_band.drive=0.2145"}, 2, "full");
  check_two(refined(hidden), "drive_efficiency", "drive_dead_band", 1.1);
}

/// These logs do not separate a constant torque from an encoder's offset.
TEST_CASE("the look-alikes of what is refused are tried, its aliases are not", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"encoder_offset.sensor=0.1"}, 204, "full");
  RefineOptions options;
  options.n_draws = 6;
  options.threads = 2;
  RefineBench bench{options, [](const PartSurvey&) { return true; }};
  bench.scan.threads = 2;
  bench.logs = hidden.logs.blocked;
  bench.logs.insert(bench.logs.end(), hidden.logs.train.begin(), hidden.logs.train.end());
  bench.all = bench.logs;
  RefineResult result;
  const RefineState state = prepare(bench, hidden.models, hidden.logs, result);
  const auto name = [](const std::optional<Trial>& trial) {
    return trial ? std::string(trial->winner.variant.effect->name) : "";
  };
  Trials trials(bench, state, true);
  CHECK(name(trials.next_alike("nothing was tried yet")).empty());
  const auto best = trials.best();
  CHECK(name(best) == "constant_torque");
  const auto other = trials.next_alike("refused");
  CHECK(name(other) == "encoder_offset");
  REQUIRE(other);
  for (const Rival& rival : other->judgement.rivals) CHECK(rival.name != "constant_torque");
  CHECK(name(trials.next_alike("refused")) != "asymmetric_coulomb");
}

/// On the base alone an encoder's offset is as good; beside the friction it is not the first
/// choice.
TEST_CASE("the first of two is named again beside the second", "[refine][slow]") {
  const HiddenLogs hidden =
      hidden_logs({"tension_friction.link=0.1568", "constant_torque.link=0.4063"}, 8);
  const RefineResult result = refined(hidden);
  INFO(result.reason);
  REQUIRE(result.effects.size() == 2);
  std::vector<std::string> names;
  for (const NamedEffect& effect : result.effects) names.emplace_back(effect.instance.effect->name);
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"constant_torque", "tension_friction"});
}

/// Table 2's link friction rises from 3.3 to 7.0 N m with preload, which (31) cannot explain: with
/// a friction that follows the tension one coefficient serves both.
TEST_CASE("one tension friction serves two preloads", "[refine][slow]") {
  const HiddenLogs hidden = hidden_logs({"tension_friction.link=5"}, 1, "preloads");
  REQUIRE(hidden.models.size() == 2);
  const RefineResult result = refined(hidden);
  REQUIRE(first_name(result) == "tension_friction");
  CHECK(result.effects[0].instance.effect->site == Site::link);
  const Estimate& mu = parameter(result, "mu");
  CHECK(mu.value == Approx(truth(hidden, "mu")).epsilon(0.01));
  CHECK(result.rho_before > 100);
  CHECK(result.rho_after < 1.2);
  CHECK(result.simulation.test_after < 2 * result.simulation.noise_floor);
  CHECK(result.models.size() == 2);
}
