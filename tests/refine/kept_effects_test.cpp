// A refined model is refined again: what it has is part of the base.
#include "cablefit/refine/null/kept_effects.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/null/base_draws.hpp"
#include "cablefit/refine/refine.hpp"
#include "cablefit/refine/search/model_set.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "tests/refine/hidden_logs.hpp"
#include "tests/support/monte_carlo.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

EffectInstance instance_of(std::string_view name, Site site, const std::vector<double>& values) {
  EffectInstance instance;
  instance.effect = &find_candidate(name, site);
  REQUIRE(values.size() == instance.effect->parameters.size());
  for (std::size_t p = 0; p < values.size(); ++p) {
    Estimate& e = instance.parameters.emplace_back();
    e.name = instance.effect->parameters[p].name;
    e.value = values[p];
  }
  return instance;
}

std::vector<Model> with(std::vector<Model> models, const EffectInstance& instance) {
  for (Model& model : models) model.joints.front().added.push_back(instance);
  return models;
}

RefineResult refined(const std::vector<Model>& models, const RefineLogs& logs,
                     std::size_t most_effects = 3) {
  RefineOptions options;
  options.n_draws = 8;
  options.threads = 2;
  options.most_effects = most_effects;
  return refine(models, logs, options);
}

KeptBase kept_base(const std::vector<Model>& models, const RefineLogs& logs) {
  std::vector<LogSurvey> all = logs.blocked;
  all.insert(all.end(), logs.train.begin(), logs.train.end());
  return fit_kept_base(models, read_stretches(all, models, [](const PartSurvey&) { return true; }),
                       smoothing_for(1e-3), {});
}

double true_value(const HiddenLogs& hidden, std::size_t effect, std::string_view name) {
  for (const hidden::Coefficient& c : hidden.truth.effects.at(effect).coefficients)
    if (c.name == name) return c.value;
  FAIL("no coefficient " << name);
  return 0;
}

const Estimate& parameter(const EffectInstance& instance, std::string_view name) {
  const Estimate* e = find_estimate(instance.parameters, name);
  REQUIRE(e != nullptr);
  return *e;
}

std::vector<std::string_view> names_in(const Model& model) {
  std::vector<std::string_view> names;
  for (const EffectInstance& has : model.joints.front().added) names.push_back(has.effect->name);
  return names;
}

const std::vector<std::string> kTwo = {"stribeck.motor=1", "quadratic_drag.link=1"};

}  // namespace

TEST_CASE("what a model has is read in its plain form where the values are those of it",
          "[refine][kept]") {
  const Model model = hidden_logs({}).models.front();
  const auto is_plain = [&](const EffectInstance& instance) {
    const std::vector<Variant> kept = kept_variants(with({model}, instance).front());
    REQUIRE(kept.size() == 1);
    CHECK(kept.front().effect == instance.effect);
    return kept.front().is_plain;
  };
  CHECK(is_plain(instance_of("stribeck", Site::motor, {0.2, 0.1, 2})));
  CHECK_FALSE(is_plain(instance_of("stribeck", Site::motor, {0.2, 0.1, 1.5})));
  CHECK(is_plain(instance_of("cogging", Site::motor, {0.2, 0.1, 0, 0, 32})));
  CHECK_FALSE(is_plain(instance_of("cogging", Site::motor, {0.2, 0.1, 0, 0.01, 32})));
  CHECK_FALSE(
      is_plain(instance_of("creep", Site::transmission, {0.01, 3, 0})));  // has only one form
  double dry = 0;
  for (const EffectInstance& has : model.joints.front().link)
    if (has.effect->follows == MotionPart::direction) dry = has.parameters.front().value;
  REQUIRE(dry > 0);
  CHECK(is_plain(instance_of("presliding", Site::link, {dry, 1e-3})));
  CHECK_FALSE(is_plain(instance_of("presliding", Site::link, {0.5 * dry, 1e-3})));
  // Its cables are in the model already.
  CHECK(kept_variants(with({model}, instance_of("dead_zone", Site::transmission, {1e-3})).front())
            .empty());
}

TEST_CASE("an event of an earlier refine is refused, and one base for two structures",
          "[refine][kept]") {
  const HiddenLogs hidden = hidden_logs({}, 1, "preloads");
  REQUIRE(hidden.models.size() == 2);
  CHECK_NOTHROW(
      require_model_set(with(hidden.models, instance_of("stribeck", Site::motor, {0.2, 0.1, 2}))));
  CHECK_THROWS_WITH(require_model_set(with(hidden.models,
                                           instance_of("payload_change", Site::link, {0.1, 0, 0}))),
                    Catch::Contains("has 'payload_change' (link), an event of an earlier refine"));
  std::vector<Model> models = hidden.models;
  models[1].joints.front().added = {instance_of("stribeck", Site::motor, {0.2, 0.1, 2})};
  CHECK_THROWS_WITH(require_model_set(models), Catch::Contains("have different equations"));
  models[0].joints.front().added = {instance_of("stribeck", Site::motor, {0.3, 0.1, 2})};
  CHECK_NOTHROW(require_model_set(models));  // coefficients are fitted anew
  models[0].joints.front().added = {instance_of("stribeck", Site::motor, {0.2, 0.2, 2})};
  CHECK_THROWS_WITH(require_model_set(models), Catch::Contains("have different equations"));
}

/// Columns of the base, so nothing of them is frozen; v_s of the file is off by half.
TEST_CASE("a kept effect is fitted with the base, its shape follows", "[refine][kept]") {
  const HiddenLogs hidden = hidden_logs({"stribeck.motor=1"});
  const double amplitude = true_value(hidden, 0, "amplitude"), v_s = true_value(hidden, 0, "v_s");
  const KeptBase kept = kept_base(
      with(hidden.models, instance_of("stribeck", Site::motor, {0.1, 1.5 * v_s, 2})), hidden.logs);
  CHECK(kept.warnings.empty());
  REQUIRE(kept.base.design.added.size() == 1);
  // Within 10 %: its sd is 3 %, and that of the amplitude as well (hide_and_name_test.cpp).
  CHECK(kept.base.design.added[0].shape[0] == Approx(v_s).epsilon(0.1));
  CHECK(kept.base.fit.x(kept.base.fit.x.size() - 1) == Approx(amplitude).epsilon(0.1));
  const KeptBase without = kept_base(hidden.models, hidden.logs);
  const auto motor = static_cast<std::size_t>(RowKind::motor);
  CHECK(kept.base.fit.rms()[motor] < 0.7 * without.base.fit.rms()[motor]);
}

TEST_CASE("a kept effect that the logs contradict is taken out", "[refine][kept]") {
  // Friction that rises ever less with speed looks like a negative drag.
  const HiddenLogs hidden = hidden_logs({"nonlinear_viscous.link=1"});
  const KeptBase kept = kept_base(
      with(hidden.models, instance_of("quadratic_drag", Site::link, {0.2, 2})), hidden.logs);
  INFO(kept.base.fit.x.transpose());
  REQUIRE(kept.warnings.size() == 1);
  CHECK(kept.warnings[0] ==
        "'quadratic_drag' (link) of the model is beyond its physical bound in these "
        "logs and was removed");
  CHECK(kept.base.design.added.empty());
}

/// More inertia of the link, in all rows, is the link's inertia.
TEST_CASE("a kept effect that the logs do not tell from the base is refused", "[refine][kept]") {
  const HiddenLogs hidden = hidden_logs({});
  try {
    kept_base(with(hidden.models, instance_of("payload_change", Site::link, {0.1, 0, 0})),
              hidden.logs);
    FAIL("it was taken");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::not_identifiable);
    CHECK(std::string(error.what()) ==
          "the logs do not separate 'payload_change' (link) of the model from its other "
          "parameters; also give the logs from which it was identified, or give a model "
          "without it");
  }
}

TEST_CASE("logs of a blocked link alone refuse what none of them shows", "[refine][kept]") {
  HiddenLogs hidden = hidden_logs({});
  hidden.logs.train.clear();
  hidden.logs.test.clear();
  const auto models = [&](std::string_view name, const std::vector<double>& values) {
    return with(hidden.models, instance_of(name, Site::transmission, values));
  };
  CHECK(stage_of(models("creep", {0.01, 3, 0}), hidden.logs).elastic_only);
  CHECK_THROWS_WITH(stage_of(models("cable_damping", {1.0}), hidden.logs),
                    "the model has 'cable_damping' (transmission), which no log with the link "
                    "blocked shows; give moving logs too, or a model without it");
}

/// With the model's own values, where nothing was fitted, they leave what a fit to them leaves:
/// what they lacked of an effect, or had of a sensor's, would stay.
TEST_CASE("simulated data sets have what the model has", "[refine][kept]") {
  struct Case {
    std::string effect;
    EffectInstance has;
    bool blocked;
  };
  const auto [effect, has, blocked] = GENERATE(
      Case{"stribeck.motor=1", instance_of("stribeck", Site::motor, {0.5, 0.15, 2}), false},
      Case{"encoder_offset.sensor=1", instance_of("encoder_offset", Site::sensor, {1e-4}), false},
      Case{"encoder_delay.sensor=0.5", instance_of("encoder_delay", Site::sensor, {1e-3}), false},
      Case{"cable_hysteresis.transmission=1",
           instance_of("cable_hysteresis", Site::transmission, {0.3, 1e-3}), true});
  HiddenLogs hidden = hidden_logs({effect}, 1, blocked ? "full" : "short");
  if (blocked) {
    hidden.logs.train.clear();
    for (Model& model : hidden.models) model.joints.front().link.clear();
  }
  std::vector<LogSurvey> all = hidden.logs.blocked;
  all.insert(all.end(), hidden.logs.train.begin(), hidden.logs.train.end());
  const BaseFit base = kept_base(with(hidden.models, has), hidden.logs).base;
  REQUIRE(base.design.added.size() == 1);
  const BaseDraws draws(
      base.design, base.fit.x, all, [](const PartSurvey&) { return true; }, 1);
  const KindLevels unfitted = draws.unfitted(1), fitted = draws.fitted(1, nullptr).fit.rms();
  for (std::size_t k = 0; k < kRowKinds; ++k) {
    INFO(effect << ": " << to_string(static_cast<RowKind>(k)));
    // Filters and reversals bias a fit (fit_bias.hpp): on the link 12 % of the rms, here as without
    // an effect. Without its effect the draws are off by 60 % and more.
    CHECK(unfitted[k] == Approx(fitted[k]).epsilon(0.2));
  }
}

TEST_CASE("a refined model is refined again: the second effect, then none",
          "[refine][kept][slow]") {
  const HiddenLogs hidden = hidden_logs(kTwo);
  const RefineResult one = refined(hidden.models, hidden.logs, 1);
  REQUIRE(names_in(one.models.front()) == std::vector<std::string_view>{"quadratic_drag"});
  const RefineResult two = refined(one.models, hidden.logs, 1);
  INFO(two.reason);
  REQUIRE(two.kept.size() == 1);
  REQUIRE(two.effects.size() == 1);
  CHECK(two.effects[0].instance.effect == &find_candidate("stribeck", Site::motor));
  CHECK(two.effects[0].evidence.p_value <= 0.01);
  CHECK(names_in(two.models.front()) ==
        std::vector<std::string_view>{"quadratic_drag", "stribeck"});
  const Estimate& drag = parameter(two.kept[0].now.instance, "coefficient");
  CHECK(drag.ci_low < true_value(hidden, 1, "coefficient"));
  CHECK(drag.ci_high > true_value(hidden, 1, "coefficient"));
  CHECK(drag.sd < 0.02 * drag.value);
  CHECK(two.kept[0].given[0].value == parameter(one.effects[0].instance, "coefficient").value);
  // As if both had been named in one go: the gap begins where the first run ended.
  CHECK(two.rho_before == Approx(one.rho_after).epsilon(0.15));
  CHECK(two.rho_after < 1.2);
  const auto shift = std::find_if(two.shifts.begin(), two.shifts.end(), [](const auto& s) {
    return s.name == "quadratic_drag (link) coefficient";
  });
  REQUIRE(shift != two.shifts.end());
  CHECK(shift->after == drag.value);
  CHECK(shift->sd == drag.sd);

  const RefineResult none = refined(two.models, hidden.logs);
  INFO(none.reason);
  CHECK(none.verdict == Verdict::none);
  CHECK(none.effects.empty());
  REQUIRE(none.kept.size() == 2);
  CHECK(none.rho_before == Approx(1).margin(0.1));
  for (const Rival& rival : none.ranking) {
    const bool is_kept = (rival.name == "stribeck" && rival.side == "motor") ||
                         (rival.name == "quadratic_drag" && rival.side == "link");
    CHECK_FALSE(is_kept);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const Estimate& before = two.models.front().joints.front().added[k].parameters.front();
    const Estimate& after = none.models.front().joints.front().added[k].parameters.front();
    CHECK(std::abs(after.value - before.value) < after.sd);  // of the same logs
  }
}

/// As in hide_and_name_test.cpp, where the first of two is named again beside the second: behind
/// what the model has.
TEST_CASE("two more effects are named beside one that the model has", "[refine][kept][slow]") {
  const HiddenLogs hidden = hidden_logs(
      {"quadratic_drag.motor=1", "tension_friction.link=0.1568", "constant_torque.link=0.4063"}, 8);
  const RefineResult result = refined(
      with(hidden.models, instance_of("quadratic_drag", Site::motor, {0.5, 2})), hidden.logs);
  INFO(result.reason);
  REQUIRE(result.kept.size() == 1);
  const Estimate& drag = parameter(result.kept[0].now.instance, "coefficient");
  CHECK(std::abs(drag.value - true_value(hidden, 0, "coefficient")) < 4 * drag.sd);
  REQUIRE(result.effects.size() == 2);
  std::vector<std::string_view> names = names_in(result.models.front());
  CHECK(names.front() == "quadratic_drag");
  std::sort(names.begin(), names.end());
  CHECK(names ==
        std::vector<std::string_view>{"constant_torque", "quadratic_drag", "tension_friction"});
  for (const RefineStep& step : result.steps) CHECK(step.added != "quadratic_drag");
  CHECK(result.rho_after < 1.2);
}

/// The null draws and the trial simulations have what the model has: a null without it would be
/// that of another drive, and its sensors' floors too high.
TEST_CASE("new logs of a refined model: nothing is named", "[refine][kept][slow][monte-carlo]") {
  struct Case {
    std::string effect, name;
  };
  const auto [effect, name] =
      GENERATE(take(full_monte_carlo() ? 3 : 1,
                    values<Case>({{"presliding.link=0.3", "presliding"},
                                  {"encoder_delay.sensor=0.2", "encoder_delay"},
                                  {"drive_dead_band.drive=0.3", "drive_dead_band"}})));
  const RefineResult one =
      refined(hidden_logs({effect}, 1).models, hidden_logs({effect}, 1).logs, 1);
  INFO(effect << ": " << one.reason);
  REQUIRE(one.effects.size() == 1);
  if (!name.empty()) CHECK(one.effects[0].instance.effect->name == name);
  const HiddenLogs later = hidden_logs({effect}, 2);
  const RefineResult again = refined(one.models, later.logs);
  INFO(again.reason);
  CHECK(again.verdict == Verdict::none);
  CHECK(again.effects.empty());
  CHECK(names_in(again.models.front()) == names_in(one.models.front()));
  CHECK(again.rho_before == Approx(1).margin(0.15));
  for (const NotSeparable& group : again.not_separable)
    for (const std::string& kept : group.effects) CHECK(kept.rfind(name + " ", 0) != 0);
  // Less the bias of the fit, see hide_and_name_test.cpp.
  CHECK(again.simulation.test_after < 1.06 * again.simulation.noise_floor);
}

TEST_CASE("models of two preloads are refined again with one coefficient", "[refine][kept][slow]") {
  const HiddenLogs hidden = hidden_logs({"tension_friction.link=5"}, 1, "preloads");
  const RefineResult result = refined(
      with(hidden.models, instance_of("tension_friction", Site::link, {0.1})), hidden.logs, 1);
  INFO(result.reason);
  CHECK(result.verdict == Verdict::none);
  REQUIRE(result.kept.size() == 1);
  // As in hide_and_name_test.cpp, where it is found.
  CHECK(parameter(result.kept[0].now.instance, "mu").value ==
        Approx(true_value(hidden, 0, "mu")).epsilon(0.01));
  REQUIRE(result.models.size() == 2);
  for (const Model& model : result.models)
    CHECK(names_in(model) == std::vector<std::string_view>{"tension_friction"});
}

/// On the base its drag is positive, as friction that falls at low speed bends that; beside the
/// friction it is negative.
TEST_CASE("a wrong effect of the model gives way to the right ones", "[refine][kept][slow]") {
  const HiddenLogs hidden = hidden_logs({"stribeck.link=1.5", "nonlinear_viscous.link=0.6"});
  const std::vector<Model> models =
      with(hidden.models, instance_of("quadratic_drag", Site::link, {0.2, 2}));
  const KeptBase base = kept_base(models, hidden.logs);
  REQUIRE(base.warnings.empty());
  REQUIRE(base.base.fit.x(base.base.fit.x.size() - 1) > 0);
  const RefineResult result = refined(models, hidden.logs);
  INFO(result.reason);
  CHECK(result.kept.empty());
  REQUIRE(result.warnings.size() == 1);
  CHECK(result.warnings[0] == taken_out(find_candidate("quadratic_drag", Site::link)));
  CHECK(names_in(result.models.front()) ==
        std::vector<std::string_view>{"stribeck", "nonlinear_viscous"});
}

/// The law falls off as exp(-|v|): what the kept form leaves of it is at the noise, and a payload
/// that changes fits it better than chance.
TEST_CASE("what a kept effect leaves is named no more than what a first one does",
          "[refine][kept]") {
  HiddenLogs hidden = hidden_logs({"stribeck.link.exponential=0.5"});
  hidden.logs.train = {hidden.logs.train.at(1), hidden.logs.train.at(2)};
  hidden.logs.test = {hidden.logs.test.at(1)};
  const RefineResult result = refined(
      with(hidden.models, instance_of("stribeck", Site::link, {0.27, 0.21, 2})), hidden.logs);
  INFO(result.reason);
  CHECK(result.verdict == Verdict::none);
  CHECK(result.effects.empty());
  REQUIRE_FALSE(result.ranking.empty());
}

/// A blocked link's draws are made without a simulator, see blocked_copy.cpp.
TEST_CASE("a model refined from blocked logs alone is refined again", "[refine][kept]") {
  const std::string effect = GENERATE("cable_hysteresis.transmission=1", "creep.transmission=2",
                                      "tension_friction.motor=1");
  HiddenLogs hidden = hidden_logs({effect}, 1, "full");
  hidden.logs.train.clear();
  hidden.logs.test.clear();
  for (Model& model : hidden.models) {
    model.joints.front().link.clear();
    model.joints.front().motor.clear();
  }
  const RefineResult one = refined(hidden.models, hidden.logs, 1);
  INFO(effect << ": " << one.reason);
  REQUIRE(one.effects.size() == 1);
  const RefineResult again = refined(one.models, hidden.logs);
  INFO(again.reason);
  CHECK(again.elastic_only);
  CHECK(again.verdict == Verdict::none);
  REQUIRE(again.kept.size() == 1);
  const Estimate& before = one.effects[0].instance.parameters.front();
  const Estimate& now = again.kept[0].now.instance.parameters.front();
  CHECK(std::abs(now.value - before.value) < before.sd);  // of the same logs
  // As in elastic_stage_test.cpp.
  CHECK(again.rho_before == Approx(1).margin(0.28));
}
