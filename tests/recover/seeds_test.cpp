// Both stages on logs of many seeds, counted up from one base: bias and honesty of the sd.
#include "tests/support/monte_carlo.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr std::uint64_t kBaseSeed = 1000;

/// Stage 1 on a blocked log and stage 2 on two moving ones, all of one seed.
std::vector<Estimate> one_run(const truth::Rig& rig, std::uint64_t seed) {
  truth::BlockedOptions blocked;
  blocked.seed = seed;
  Bench stage1;
  stage1.add(truth::simulate_blocked(rig, blocked));
  const ElasticResult elastic = fit_elastic(stage1.logs(), {});
  Bench stage2;
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions moving;
    moving.seed = seed;
    moving.duration = 10;
    moving.load = load;
    stage2.add(truth::simulate_moving(rig, moving));
  }
  std::vector<Estimate> all = fit_dynamic(stage2.logs(), elastic, {}).preloads.at(0).fits.at(0).parameters;
  const ElasticPreload& preload = elastic.preloads.at(0);
  const ElasticFit* poly = preload.find("poly");
  all.insert(all.end(), poly->parameters.begin(), poly->parameters.end());
  return all;
}

std::vector<RunTable> many_runs(const truth::Rig& rig, const NamedValues& truth, int n_runs) {
  std::vector<RunTable> tables;
  for (const auto& [name, value] : truth) tables.push_back({name, value, {}, {}, 0, 0});
  for (int run = 0; run < n_runs; ++run) {
    const std::vector<Estimate> found = one_run(rig, kBaseSeed + static_cast<std::uint64_t>(run));
    for (RunTable& table : tables) table.add(estimate(found, table.name));
  }
  return tables;
}

TEST_CASE("x","[recover]") {
  for (const RunTable& t : many_runs(truth::Rig::low(), dynamic_truth(truth::Rig::low()), 20)) t.print();
  for (const RunTable& t : many_runs(truth::Rig::low(), elastic_truth(truth::Rig::low()), 20)) t.print();
  for (const RunTable& t : many_runs(truth::Rig::high(), dynamic_truth(truth::Rig::high()), 20)) t.print();
}
}
