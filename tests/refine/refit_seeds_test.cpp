// A model with two effects is fitted anew to many logs of the second simulator, each of another rig
// and with other noise: the intervals of these estimators cover the truth.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/curve_of_model.hpp"
#include "cablefit/identify/identify.hpp"
#include "tests/refine/hidden_logs.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// How often a parameter's 95 % interval has the truth inside.
struct Inside {
  double n = 0, inside = 0;
  double undetermined = 0;  ///< by these logs: no interval
  double squared = 0;       ///< sum of (error / sd)^2

  void add(const Estimate& e, double truth) {
    if (!e.not_identifiable.empty()) {
      ++undetermined;
      return;
    }
    ++n;
    squared += (e.value - truth) / e.sd * ((e.value - truth) / e.sd);
    inside += e.ci_low <= truth && truth <= e.ci_high ? 1 : 0;
  }
  double share() const { return inside / n; }
  double rms() const { return std::sqrt(squared / n); }
};

std::map<std::string, double> truth_of(const HiddenLogs& logs) {
  const hidden::Rig& rig = logs.truth.bench.rig;
  std::map<std::string, double> truth = {{"J_motor", rig.J_motor}, {"f_vm", rig.f_vm},
                                         {"f_sm", rig.f_sm},       {"J_link", rig.J_link},
                                         {"f_v", rig.f_v},         {"f_s", rig.f_s}};
  const std::string labels[] = {"stribeck[motor].", "quadratic_drag[link]."};
  for (std::size_t k = 0; k < 2; ++k)
    for (const hidden::Coefficient& c : logs.truth.effects[k].coefficients)
      if (c.name != "exponent") truth[labels[k] + c.name] = c.value;
  return truth;
}

/// As `refine` would have named them; their values begin off the truth.
std::vector<EffectInstance> begun_off(const std::map<std::string, double>& truth) {
  return {effect_at("stribeck", Site::motor, {0.1, 1.3 * truth.at("stribeck[motor].v_s"), 2}),
          effect_at("quadratic_drag", Site::link, {0.1, 2})};
}

std::vector<Estimate> fitted(const HiddenLogs& logs, const std::vector<EffectInstance>& effects,
                             const std::string& estimator) {
  if (estimator == "identify") {
    IdentifyOptions options;
    options.effects = {effects};
    const IdentifyResult result = identify(all_training(logs.logs), options);
    std::vector<Estimate> found = result.parameters;
    const std::vector<Estimate>& own = result.preloads.at(0).parameters;
    found.insert(found.end(), own.begin(), own.end());
    return found;
  }
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = estimator;
  options.effects = {effects};
  const ElasticResult curve = curve_of(logs.models.front());
  const DynamicResult result = fit_dynamic(logs.logs.train, curve, options);
  const DynamicFit& fit = result.preloads.at(0).fits.at(0);
  if (estimator == "output-error") {  // no fall back, and its own bias is in the intervals
    CHECK(fit.estimator == estimator);
    CHECK(fit.method_floor.at("stribeck[motor].amplitude") > 0);
  }
  return fit.parameters;
}

TEST_CASE("intervals of a model with two effects cover the truth", "[refine][slow]") {
  const std::string estimator = GENERATE("wls", "iv", "auto", "identify", "output-error");
  CAPTURE(estimator);
  const unsigned long runs = full_monte_carlo() ? 50 : 3;
  std::map<std::string, Inside> tables;
  Inside all;
  for (unsigned long seed = 1; seed <= runs; ++seed) {
    const HiddenLogs logs =
        hidden_logs({"stribeck.motor=1", "quadratic_drag.link=1"}, seed, "full");
    const auto truth = truth_of(logs);
    const std::vector<Estimate> found = fitted(logs, begun_off(truth), estimator);
    for (const auto& [name, value] : truth) {
      CAPTURE(seed, name, value);
      const Estimate* e = find_estimate(found, name);
      REQUIRE(e != nullptr);
      REQUIRE((e->sd > 0 || !e->not_identifiable.empty()));
      tables[name].add(*e, value);
      all.add(*e, value);
    }
  }
  std::printf(
      "  %s: %.1f %% of %.0f inside their 95 %% interval, errors of %.2f sd rms; %.0f more are "
      "not determined\n",
      estimator.c_str(), 100 * all.share(), all.n, all.rms(), all.undetermined);
  for (const auto& [name, table] : tables)
    std::printf("    %-32s %3.0f %% of %.0f, %.2f sd rms\n", name.c_str(), 100 * table.share(),
                table.n, table.rms());
  CHECK(all.share() > (full_monte_carlo() ? 0.9 : 0.8));
  CHECK(all.rms() > 0.5);  // intervals that are far too wide cover too
  CHECK(all.undetermined < 0.25 * (all.n + all.undetermined));
}

}  // namespace
