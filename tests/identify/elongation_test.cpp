// l_o by variable projection: the same from any start, intervals that cover, and no number where
// the data cannot tell.
#include "cablefit/identify/elongations/elongation_search.hpp"
#include "cablefit/identify/preload_records.hpp"
#include "tests/identify/simulated_rigs.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Three preloads of the same cables, blocked.
PreloadedBench three_preloads(std::uint64_t seed) {
  PreloadedBench bench;
  int n = 0;
  for (const double l_o : {0.0, 3e-3, 9e-3})
    bench.add(fmt::format("p{}", n++), blocked_log(stretched(l_o), seed++));
  return bench;
}

/// The blocked equation of every preload, all l_o searched.
JointFit blocked_fit(const PreloadedBench& bench) {
  std::vector<PreloadFacts> facts;
  for (const LogSurvey& log : bench.logs()) {
    facts.emplace_back();
    facts.back().name = log.parts.front().preload;
    facts.back().rig = log.plan.rig;
  }
  const IdentifyOptions options;
  IdentifyResult ignored;
  std::vector<PreloadJob> jobs = begin_jobs(bench.logs(), options, facts, ignored);
  for (std::size_t j = 0; j < jobs.size(); ++j)
    jobs[j].records = {blocked_record(bench.logs(), options, false, facts[j])};
  return make_joint_fit(bench.logs(), jobs, false, false, 1);
}

// Each search starts from a grid of its own, stretched at random.
TEST_CASE("l_o is the same from 20 random grids of starts", "[identify]") {
  const PreloadedBench bench = three_preloads(50);
  JointFit fit = blocked_fit(bench);
  const JointPoint best = search_elongations(fit);
  const double truth[] = {0, 3e-3, 9e-3};
  for (std::size_t j = 0; j < 3; ++j)
    CHECK(std::abs(best.l_o[j](0) - truth[j]) < 5e-5);  // sd about 1e-5
  const std::vector<double> weights = fit.weights;
  Normal random(77);
  for (int i = 0; i < 20; ++i) {
    const JointPoint found = search_elongations(fit, 1 + 0.4 * random.uniform());
    fit.weights = weights;  // those of one grid, to compare like with like
    const JointPoint end = polish(fit, found);
    // Steps end at 1e-8 of the reach of 90 mrad, a ten thousandth of an sd.
    CHECK(std::abs(end.merit() - best.merit()) < 1e-6);
    for (std::size_t j = 0; j < 3; ++j)
      CHECK((end.l_o[j] - best.l_o[j]).cwiseAbs().maxCoeff() < 2e-8);
  }
}

// 40 rigs (400 with CABLEFIT_MONTE_CARLO=full): of 80 intervals of the preloaded cables, which are
// pairwise nearly the same by equilibrium, 95 % are 38 of 40; the 99.9 % band of a binomial of 40
// reaches down to 32. With 400 it is 91 to 98.5 %.
TEST_CASE("profile intervals of l_o cover the truth", "[identify][monte-carlo]") {
  const int runs = full_monte_carlo() ? 400 : 40;
  int covered[2] = {0, 0};
  double distance = 0;
  for (int run = 0; run < runs; ++run) {
    PreloadedBench bench;
    const auto seed = 1000 + 2 * static_cast<std::uint64_t>(run);
    bench.add("low", blocked_log(truth::Rig::low(), seed));
    bench.add("high", blocked_log(truth::Rig::high(), seed + 1));
    const IdentifyResult r = identify(bench.logs(), {});
    const double truth[] = {truth::Rig::high().cable_1.initial_elongation,
                            truth::Rig::high().cable_2.initial_elongation};
    for (int c = 0; c < 2; ++c) {
      const Estimate& e = estimate(r.preloads.at(1).parameters, fmt::format("l_o[{}]", c + 1));
      covered[c] += e.ci_low <= truth[c] && truth[c] <= e.ci_high;
      distance += (e.value - truth[c]) / e.sd / (2 * runs);
    }
  }
  std::printf("  l_o of %d rigs: covered %d and %d, mean distance %+.2f sd\n", runs, covered[0],
              covered[1], distance);
  const double low = full_monte_carlo() ? 0.91 : 0.8, high = full_monte_carlo() ? 0.985 : 1;
  for (const int n : covered) {
    CHECK(n >= low * runs);
    CHECK(n <= high * runs);
  }
  // -0.29 sd in 400 rigs: the low preload may be a gap, but hardly a preload, and the high one
  // leans on the same coefficients.
  CHECK(std::abs(distance) < 0.5 + 4 / std::sqrt(2 * runs));
}

truth::Rig linear_pair(double l_o) {
  truth::Rig rig = truth::Rig::low();
  rig.cable_1 = {{1900}, l_o};
  rig.cable_2 = {{1700}, 1900 * l_o / 1700};
  return rig;
}

// Both cables always taut and linear: the torque is (K1_0 + K2_0) phi, and no more is in it.
TEST_CASE("linear cables in closure tell their sum only", "[identify]") {
  PreloadedBench bench;
  bench.add("tight", blocked_log(linear_pair(0.03), 5, 0.01));
  IdentifyOptions options;
  options.order = 1;
  options.elongations = ElongationMode::search;
  const IdentifyResult r = identify(bench.logs(), options);
  for (const char* name : {"K1_0", "K2_0"}) {
    const Estimate& e = estimate(r.parameters, name);
    INFO(name << " " << e.value << " " << e.not_identifiable);
    CHECK(e.not_identifiable.find("determined is K1_0 + K2_0 = 3") != std::string::npos);
    CHECK(std::isnan(e.sd));
  }
  for (const char* name : {"l_o[1]", "l_o[2]"})
    CHECK(!estimate(r.preloads.at(0).parameters, name).not_identifiable.empty());
  CHECK(r.profiles.empty());
  // Once a cable goes slack all of it is known.
  PreloadedBench wide;
  wide.add("tight", blocked_log(linear_pair(0.01), 5, 0.045));
  const IdentifyResult told = identify(wide.logs(), options);
  check_recovered(told.parameters, {{"K1_0", 1900}, {"K2_0", 1700}}, 3);
  check_recovered(told.preloads.at(0).parameters, {{"l_o[1]", 0.01}, {"l_o[2]", 0.019 / 1.7}}, 3);
}

// A gap is an l_o below 0: both cables are slack in the reference pose, and nothing balances.
TEST_CASE("a gap is found as negative elongations", "[identify][recover]") {
  truth::Rig rig = truth::Rig::low();
  rig.cable_1.initial_elongation = -2e-3;
  rig.cable_2.initial_elongation = -1e-3;
  PreloadedBench bench;
  bench.add("slack", blocked_log(rig, 9));
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  const IdentifyResult r = identify(bench.logs(), options);
  check_recovered(r.preloads.at(0).parameters, {{"l_o[1]", -2e-3}, {"l_o[2]", -1e-3}}, 3);
}

}  // namespace
