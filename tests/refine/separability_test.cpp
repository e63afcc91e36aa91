// Which effects these logs could separate, and which run would, from the columns alone.
#include <catch2/catch.hpp>

#include <algorithm>

#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/search/search.hpp"
#include "cablefit/refine/steps/next_run.hpp"
#include "cablefit/refine/verdict/separability.hpp"
#include "tests/refine/hidden_logs.hpp"

using namespace cablefit;
using namespace cablefit::test;

namespace {

BaseFit base_of(const HiddenLogs& hidden, const std::vector<LogSurvey>& logs) {
  return fit_base(
      make_design(hidden.models,
                  read_stretches(logs, hidden.models, [](const PartSurvey&) { return true; }),
                  smoothing_for(1e-3)),
      2, nullptr);
}

std::vector<NotSeparable> groups_of(const BaseFit& base) {
  return find_not_separable(base.design, base.fit.x, base.fit.rms(), trial_runs(base.design));
}

const NotSeparable* group_with(const std::vector<NotSeparable>& groups, const std::string& a,
                               const std::string& b) {
  const auto has = [](const NotSeparable& group, const std::string& name) {
    return std::find(group.effects.begin(), group.effects.end(), name) != group.effects.end();
  };
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const NotSeparable& group) {
    return has(group, a) && has(group, b);
  });
  return found != groups.end() ? &*found : nullptr;
}

}  // namespace

/// Under one load the torque of the cables hardly changes: a share of it is a constant.
TEST_CASE("one load cannot tell a gain from a constant, and another load would",
          "[refine][separability]") {
  const HiddenLogs hidden = hidden_logs({}, 1, "one_load");
  const BaseFit base = base_of(hidden, all_training(hidden.logs));
  const auto groups = groups_of(base);
  const NotSeparable* group = group_with(groups, "constant_torque (link)", "load_scale (link)");
  REQUIRE(group != nullptr);
  CHECK_FALSE(group->is_alias);
  REQUIRE(group->run >= 0);
  const TrialRun run = trial_runs(base.design)[static_cast<std::size_t>(group->run)];
  INFO(group->next_run);
  // The load of all these logs is 30 N m.
  CHECK(std::abs(run.load - 30) > 1);
  CHECK(std::find(group->still_together.begin(), group->still_together.end(),
                  "load_scale (link)") == group->still_together.end());
  // Three loads have no such group.
  const HiddenLogs full = hidden_logs({}, 1, "short");
  const auto fewer = groups_of(base_of(full, all_training(full.logs)));
  CHECK(group_with(fewer, "constant_torque (link)", "load_scale (link)") == nullptr);
}

TEST_CASE("aliases are never told apart, and no run is promised", "[refine][separability]") {
  const HiddenLogs full = hidden_logs({}, 1, "short");
  const auto groups = groups_of(base_of(full, all_training(full.logs)));
  const NotSeparable* scale = group_with(groups, "torque_gain (drive)", "load_scale (link)");
  REQUIRE(scale != nullptr);
  CHECK(scale->is_alias);
  CHECK(scale->next_run.empty());
  CHECK(group_with(groups, "stribeck (motor)", "cogging (motor)") == nullptr);
}

/// The part that a rival can still fit determines nothing: its given values do not matter.
TEST_CASE("a run tells rivals apart by what they cannot bend to", "[refine][separability]") {
  const HiddenLogs hidden = hidden_logs({"constant_torque.link=1"}, 1, "one_load");
  const BaseFit base = base_of(hidden, all_training(hidden.logs));
  const KindLevels floor = base.fit.rms();
  const Search found = search(base.design, floor, {});
  const auto candidate = [&](std::string_view name) {
    return *std::find_if(found.candidates.begin(), found.candidates.end(),
                         [&](const Candidate& c) { return c.variant.effect->name == name; });
  };
  const Candidate best = candidate("constant_torque"), rival = candidate("load_scale");
  Candidate bent = rival;
  bent.x *= 1.1;
  std::vector<TrialRun> runs = trial_runs(base.design);
  runs.resize(2);
  const auto from = [&](const Candidate& other) {
    return decisive_run(base.design, base.fit.x, best, {&other}, floor, runs);
  };
  const auto own = from(rival), other = from(bent);
  REQUIRE(own);
  REQUIRE(other);
  CHECK(own->run == other->run);
  CHECK(own->difference == Approx(other->difference));
}

/// References stay within what the logs have seen, and the fitted model can follow them.
TEST_CASE("trial runs keep to the limits of the logs", "[refine][separability]") {
  const HiddenLogs hidden = hidden_logs({}, 1, "short");
  const BaseFit base = base_of(hidden, all_training(hidden.logs));
  double low = kUnbounded, high = -kUnbounded, speed = 0, least_load = 0, most_load = 0;
  for (std::size_t k = 0; k < base.design.stretches.size(); ++k) {
    if (base.design.stretches[k].blocked) continue;
    const SmoothMotion& m = *base.design.rows[k].motion;
    low = std::min(low, m.theta.minCoeff());
    high = std::max(high, m.theta.maxCoeff());
    speed = std::max(speed, m.thetad.abs().maxCoeff());
    least_load = std::min(least_load, m.tau_load.minCoeff());
    most_load = std::max(most_load, m.tau_load.maxCoeff());
  }
  const std::vector<TrialRun> runs = trial_runs(base.design);
  REQUIRE(runs.size() >= 6);
  CHECK(runs.back().blocked);
  for (const TrialRun& run : runs) {
    INFO(text_of(run, Axes::rotary));
    const Eigen::Index n = run.theta_ref.size();
    const Eigen::ArrayXd rate =
        (run.theta_ref.tail(n - 1) - run.theta_ref.head(n - 1)) / run.period;
    if (!run.blocked) {
      // A dither of a fifth of the acceleration seen, at 7 Hz and more, adds little.
      const double slack = 0.05 * (high - low);
      CHECK(run.theta_ref.minCoeff() > low - slack);
      CHECK(run.theta_ref.maxCoeff() < high + slack);
      CHECK(rate.abs().maxCoeff() < 1.1 * speed);
      CHECK(run.load >= -std::max(-least_load, most_load));
      CHECK(run.load <= std::max(-least_load, most_load));
    }
    Model model = base.design.models.front();
    CHECK(simulated(run, model));
  }
}
