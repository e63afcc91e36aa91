// Both stages on simulated logs of many seeds, counted up from one base: bias, and sd against the
// scatter that really occurs.
#include "tests/support/monte_carlo.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr std::uint64_t kBaseSeed = 1000;

/// Stage 1 on a blocked log and stage 2 on two moving ones. Every log has a seed of its own: equal
/// seeds would give both moving logs the same noise.
std::vector<Estimate> one_run(const truth::Rig& rig, std::uint64_t& seed) {
  truth::BlockedOptions blocked;
  blocked.seed = seed++;
  Bench stage1;
  stage1.add(truth::simulate_blocked(rig, blocked));
  const ElasticResult elastic = fit_elastic(stage1.logs(), {});
  Bench stage2;
  for (const double load : {30.0, -40.0}) {
    truth::MovingOptions moving;
    moving.seed = seed++;
    moving.duration = 8;
    moving.load = load;
    stage2.add(truth::simulate_moving(rig, moving));
  }
  std::vector<Estimate> all =
      fit_dynamic(stage2.logs(), elastic, {}).preloads.at(0).fits.at(0).parameters;
  for (const Estimate& e : elastic.preloads.at(0).find("poly")->parameters)
    if (e.name.front() == 'K') all.push_back(e);
  return all;
}

std::vector<RunTable> many_runs(const truth::Rig& rig, const NamedValues& truth, int n_runs) {
  std::vector<RunTable> tables;
  for (const auto& [name, value] : truth) tables.push_back({name, value, {}, {}, 0, 0});
  std::uint64_t seed = kBaseSeed;
  for (int run = 0; run < n_runs; ++run) {
    const std::vector<Estimate> found = one_run(rig, seed);
    for (RunTable& table : tables) table.add(estimate(found, table.name));
  }
  return tables;
}

int n_runs() { return full_monte_carlo() ? 200 : 20; }

/// A mean within `percent` of the truth, or within three standard errors of it (the offset is a
/// hundredth of the torque's noise: no log tells it to one per cent).
void check_mean(const RunTable& t, double percent) {
  INFO(t.name << ": mean " << t.mean() << " +- " << t.standard_error() << ", true " << t.truth);
  CHECK(std::abs(t.bias()) <
        std::max(percent / 100 * std::abs(t.truth), 3 * t.standard_error()));
}

TEST_CASE("x","[recover]") {
  NamedValues t = dynamic_truth(truth::Rig::low());
  const NamedValues k = elastic_truth(truth::Rig::low());
  t.insert(t.end(), k.begin(), k.end());
  for (const RunTable& t : many_runs(truth::Rig::low(), t, n_runs())) { t.print(); check_mean(t,1); }
  for (const RunTable& t : many_runs(truth::Rig::high(), dynamic_truth(truth::Rig::high()), n_runs())) {t.print();check_mean(t,1);}
}
}
