// A model with effects beyond the paper's is fitted anew by stage 2: every effect is a column (or
// one per nonlinear parameter), and every estimator has it. The logs come from the second simulator
// (tests/hidden), which shares no code with the library.
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/dynamic/rows/added_effects.hpp"
#include "cablefit/elastic/curve_of_model.hpp"
#include "tests/refine/hidden_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

double truth_of(const HiddenLogs& logs, std::size_t effect, const std::string& name) {
  for (const hidden::Coefficient& c : logs.truth.effects[effect].coefficients)
    if (c.name == name) return c.value;
  FAIL("no " << name);
  return 0;
}

DynamicFit refitted(const HiddenLogs& logs, std::vector<EffectInstance> effects,
                    const std::string& estimator) {
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = estimator;
  options.effects = {std::move(effects)};
  const ElasticResult curve = curve_of(logs.models.front());
  return fit_dynamic(logs.logs.train, curve, options).preloads.at(0).fits.at(0);
}

TEST_CASE("stage 2 finds the values of two effects of a model", "[refine]") {
  const HiddenLogs logs = hidden_logs({"stribeck.motor=1", "quadratic_drag.link=1"}, 3, "full");
  const std::string estimator = GENERATE("wls", "iv", "auto", "output-error");
  CAPTURE(estimator);
  const double v_s = truth_of(logs, 0, "v_s");
  // It starts 40 % off, with no idea of the amplitudes.
  const DynamicFit fit = refitted(logs,
                                  {effect_at("stribeck", Site::motor, {0.1, 1.4 * v_s, 2}),
                                   effect_at("quadratic_drag", Site::link, {0.1, 2})},
                                  estimator);
  if (estimator != "auto") CHECK(fit.estimator == estimator);  // none fell back to another
  const std::vector<std::pair<std::string, double>> truth = {
      {"stribeck[motor].amplitude", truth_of(logs, 0, "amplitude")},
      {"stribeck[motor].v_s", v_s},
      {"quadratic_drag[link].coefficient", truth_of(logs, 1, "coefficient")},
      {"J_motor", logs.truth.bench.rig.J_motor},
      {"J_link", logs.truth.bench.rig.J_link},
      {"f_v", logs.truth.bench.rig.f_v}};
  for (const auto& [name, value] : truth) {
    CAPTURE(name, value);
    const Estimate* e = find_estimate(fit.parameters, name);
    REQUIRE(e != nullptr);
    CAPTURE(e->value, e->sd, e->not_identifiable);
    REQUIRE(e->sd > 0);
    CHECK(std::abs(e->value - value) < 3.5 * e->sd);  // 24 numbers: 1 in 90 runs
    CHECK(e->sd < 0.2 * std::abs(value));
  }
  // The model that is written has the same numbers.
  REQUIRE(fit.effects.size() == 1);
  REQUIRE(fit.effects[0].size() == 2);
  CHECK(fit.effects[0][0].parameters[1].value ==
        find_estimate(fit.parameters, "stribeck[motor].v_s")->value);
  CHECK(fit.effects[0][0].parameters[2].value == 2);  // the Gaussian law, held
}

TEST_CASE("stage 2 without the effects is wrong where they are", "[refine]") {
  const HiddenLogs logs = hidden_logs({"stribeck.motor=1", "quadratic_drag.link=1"}, 3, "full");
  const DynamicFit plain = refitted(logs, {}, "wls");
  const DynamicFit with = refitted(logs,
                                   {effect_at("stribeck", Site::motor, {0.1, 0.1, 2}),
                                    effect_at("quadratic_drag", Site::link, {0.1, 2})},
                                   "wls");
  CHECK(with.torque_error.at("motor").rms < 0.9 * plain.torque_error.at("motor").rms);
  CHECK(with.torque_error.at("link").rms < 0.9 * plain.torque_error.at("link").rms);
}

TEST_CASE("what stage 2 cannot fit of a model is refused by name", "[refine]") {
  const HiddenLogs logs = hidden_logs({});
  CHECK_THROWS_WITH(
      refitted(logs, {effect_at("encoder_delay", Site::sensor, {1e-3})}, "wls"),
      "'encoder_delay' (sensor) is not fitted here: it is an error of a sensor or of the drive; "
      "correct the log by its rig file, or drop it from the model; 'cablefit refine' fits it");
  CHECK_THROWS_WITH(refitted(logs, {effect_at("creep", Site::transmission, {1e-5, 3, 0})}, "wls"),
                    "'creep' (transmission) is not fitted here: its memory is longer than the "
                    "blocks in which logs are read; drop it from the model; 'cablefit refine' fits "
                    "it");
}

TEST_CASE("what acts between the sides is held at the model's values", "[refine]") {
  const auto effects = std::vector{effect_at("cable_damping", Site::transmission, {3})};
  for (const Side side : {Side::link, Side::motor}) {
    const std::vector<AddedEffect> own = effects_of_side(effects, side, 0);
    REQUIRE(own.size() == 1);
    const std::vector<DynamicParameter> parameters = parameters_of(own.front(), 1);
    REQUIRE(parameters.size() == 1);
    CHECK(parameters.front().name == "cable_damping[transmission].damping");
    CHECK(parameters.front().given == 3.0);
  }
  CHECK(effects_of_side(effects, Side::rigid, 0).empty());
}

}  // namespace
