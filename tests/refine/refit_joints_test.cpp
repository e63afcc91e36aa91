// A model of several joints with effects beyond the paper's is fitted anew, each effect on its
// joint. The logs are made by plain arithmetic that shares nothing with the library.
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/dynamic/fit_model.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/model/effects/effect_names.hpp"
#include "tests/refine/refined_finger.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace cablefit::test {
namespace {

/// Logs of a rig, blocked and moving.
Bench bench_with(const PlainRig& given, const PlainRig& hidden, const std::string& more) {
  Bench bench;
  if (const PlainArm* arm = given.link_dynamics.target<PlainArm>())
    bench.folder().write("finger.urdf", urdf_text(*arm, "finger"));
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(given, more)));
  bench.add_text(blocked_log(hidden, std::vector<double>(given.n(), 0.1), 60, 11, 200, 0, 0.005));
  bench.add_text(moving_log(hidden, 20, 12));
  return bench;
}

/// The effects of names such as "stribeck[motor 2]", at values beside the truth.
EffectsPerJoint effects_at(const std::vector<std::string>& names,
                           const std::vector<std::vector<double>>& values, int n_joints) {
  EffectsPerJoint effects = blank_effects(names, n_joints);
  auto next = values.begin();
  for (std::vector<EffectInstance>& own : effects)
    for (EffectInstance& effect : own) {
      for (std::size_t k = 0; k < effect.parameters.size(); ++k)
        effect.parameters[k].value = next->at(k);
      ++next;
    }
  return effects;
}

DynamicPreload refitted(const Bench& bench, EffectsPerJoint effects, const std::string& estimator) {
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = estimator;
  options.effects = std::move(effects);
  return fit_dynamic(bench.logs(), fit_elastic(bench.logs(), {}), options).preloads.at(0);
}

/// Within 4 sd, and the sd of what is there is below a third of it.
void check_refitted(const std::vector<Estimate>& found, const NamedValues& truth) {
  check_recovered(found, truth, 4);
  for (const auto& [name, value] : truth) {
    INFO(name);
    if (value != 0) CHECK(estimate(found, name).sd < std::abs(value) / 3);
  }
}

double mu_of(const PlainRig& hidden, double size) {
  const std::vector<double> zero(hidden.n(), 0.0);
  double at_rest = 0;
  for (const PlainCable& cable : hidden.cables)
    at_rest += std::abs(cable.link[0].slope(0)) * cable.force(zero, zero);
  return size * hidden.joints[0].f_s / at_rest;
}

TEST_CASE("stage 2 fits an effect on one of several joints", "[refine]") {
  PlainRig hidden = tendon_finger();
  find_joint_effect("stribeck", "motor").hide(hidden, 1, 1);
  const Bench bench = bench_with(tendon_finger(), hidden, "");
  const EffectsPerJoint effects = effects_at({"stribeck[motor 2]"}, {{0.01, 0.4, 2}}, 2);
  const NamedValues truth = {{"stribeck[motor].amplitude[2]", hidden.joints[1].f_sm},
                             {"stribeck[motor].v_s[2]", 0.3},
                             {"f_sm[1]", hidden.joints[0].f_sm},
                             {"f_sm[2]", hidden.joints[1].f_sm}};
  const std::string estimator = GENERATE("wls", "iv", "auto", "output-error");
  CAPTURE(estimator);
  const DynamicPreload preload = refitted(bench, effects, estimator);
  const DynamicFit& fit = preload.fits.at(0);
  if (estimator != "auto") CHECK(fit.estimator == estimator);
  check_refitted(fit.parameters, truth);
  // The model has it on its joint, with the same number.
  const Model model = model_of(fit, preload, bench.rig);
  CHECK(model.joints[0].added.empty());
  REQUIRE(model.joints[1].added.size() == 1);
  CHECK(model.joints[1].added[0].parameters[0].value ==
        estimate(fit.parameters, "stribeck[motor].amplitude[2]").value);
}

TEST_CASE("stage 2 finds first values of an effect on every joint", "[refine]") {
  PlainRig hidden = tendon_finger();
  find_joint_effect("stribeck", "motor").hide(hidden, 0, 1);
  const Bench bench = bench_with(tendon_finger(), hidden, "");
  const DynamicPreload preload = refitted(bench, blank_effects({"stribeck[motor]"}, 2), "wls");
  const std::vector<Estimate>& found = preload.fits.at(0).parameters;
  check_refitted(found, {{"stribeck[motor].amplitude[1]", hidden.joints[0].f_sm}});
  const Estimate& none = estimate(found, "stribeck[motor].amplitude[2]");
  CHECK((!none.not_identifiable.empty() || std::abs(none.value) < 4 * none.sd));
}

TEST_CASE("stage 2 fits effects of links that move each other", "[refine]") {
  PlainRig hidden = phalanges_rig();
  find_joint_effect("quadratic_drag", "link").hide(hidden, 1, 1);
  const Bench bench = bench_with(phalanges_rig(), hidden, kWithArm);
  const EffectsPerJoint effects =
      effects_at({"quadratic_drag[link 1]", "quadratic_drag[link 2]"}, {{0.1, 2}, {0.1, 2}}, 2);
  const std::string estimator = GENERATE("wls", "iv", "output-error");
  CAPTURE(estimator);
  const DynamicFit fit = refitted(bench, effects, estimator).fits.at(0);
  CHECK(fit.estimator == estimator);
  check_refitted(fit.parameters,
                 {{"quadratic_drag[link].coefficient[1]", 0},
                  {"quadratic_drag[link].coefficient[2]", 0.3 * hidden.joints[1].f_s},
                  {"f_s[2]", hidden.joints[1].f_s}});
}

// The link equations of an arm have the columns of each other's effects, all of them 0.
TEST_CASE("stage 2 finds first values of an effect on a link that moves another", "[refine]") {
  PlainRig hidden = phalanges_rig();
  find_joint_effect("stribeck", "link").hide(hidden, 0, 1);
  const Bench bench = bench_with(phalanges_rig(), hidden, kWithArm);
  const DynamicPreload preload = refitted(bench, blank_effects({"stribeck[link 1]"}, 2), "wls");
  check_refitted(preload.fits.at(0).parameters,
                 {{"stribeck[link].amplitude[1]", hidden.joints[0].f_s}});
}

TEST_CASE("friction on paths needs a cable that passes several joints", "[refine]") {
  PlainRig rig = paired_finger();
  rig.cables[2].link[0] = rig.cables[3].link[0] = round_map(0);
  const Bench bench = bench_with(rig, rig, "");
  CHECK_THROWS_WITH(refitted(bench, blank_effects({"path_friction[link 2]"}, 2), "wls"),
                    "'path_friction' (link 2) is not fitted here: no cable passes several "
                    "joints; drop it from the model");
}

TEST_CASE("friction of cables on their path is fitted with everything else", "[refine]") {
  PlainRig hidden = tendon_finger();
  find_joint_effect("path_friction", "link").hide(hidden, 0, 1);
  const Bench bench = bench_with(tendon_finger(), hidden, "");
  const EffectsPerJoint effects = effects_at({"path_friction[link]"}, {{0.1}, {0.1}}, 2);
  const DynamicFit fit = refitted(bench, effects, "wls").fits.at(0);
  const double mu = mu_of(hidden, 1);
  check_refitted(fit.parameters,
                 {{"path_friction[link].mu[1]", mu}, {"path_friction[link].mu[2]", mu}});
}

TEST_CASE("one step fits effects of several joints", "[refine]") {
  for (const bool coupled : {false, true}) {
    INFO("coupled links: " << coupled);
    const PlainRig given = coupled ? four_cable_phalanges() : four_cable_finger();
    PlainRig hidden = given;
    find_joint_effect("stribeck", "motor").hide(hidden, 1, 1);
    const Bench bench = bench_with(given, hidden, coupled ? kWithArm : "");
    IdentifyOptions options;
    options.elongations = ElongationMode::search;
    options.effects = effects_at({"stribeck[motor 2]"}, {{0.1, 0.4, 2}}, 2);
    const IdentifyResult result = identify(bench.logs(), options);
    std::vector<Estimate> found = result.parameters;
    const std::vector<Estimate>& own = result.preloads.at(0).parameters;
    found.insert(found.end(), own.begin(), own.end());
    check_refitted(found, {{"stribeck[motor].amplitude[2]", hidden.joints[1].f_sm},
                           {"stribeck[motor].v_s[2]", 0.3},
                           {"f_sm[2]", hidden.joints[1].f_sm}});
  }
}

TEST_CASE("an effect that names a joint is checked against the rig", "[refine]") {
  CHECK_THROWS_WITH(blank_effects({"stribeck[motor 3]"}, 2),
                    "effect 'stribeck[motor 3]': the rig file has 2 joints; name one of its "
                    "joints, or leave the number out for each of them");
  CHECK_THROWS_WITH(blank_effects({"stribeck[motor x]"}, 2),
                    "effect 'stribeck[motor x]' names no joint; write stribeck[motor 2] for the "
                    "second joint");
}

}  // namespace
}  // namespace cablefit::test
