// Over seeds: the intervals of cables that two joints share, and of both joints, cover the truth.
#include <map>

#include "tests/recover/joints_truth.hpp"
#include "tests/support/monte_carlo.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {
namespace {

/// By stage, as names occur in both.
using Tables = std::map<std::string, RunTable>;

void add(Tables& tables, const std::string& stage, const std::vector<Estimate>& estimates,
         const NamedValues& truth) {
  for (const auto& [name, value] : truth) {
    RunTable& table = tables[stage + name];
    table.name = name;
    table.truth = value;
    table.add(estimate(estimates, name));
  }
}

void run(const PlainRig& plain, const Rig& rig, unsigned seed, Tables& tables) {
  Bench bench;
  bench.rig = rig;
  bench.add_text(blocked_log(plain, {0.1, 0.1}, 60, seed));
  bench.add_text(moving_log(plain, 8, seed + 1000));
  const ElasticResult elastic = fit_elastic(bench.logs(), {});
  add(tables, "1 ", elastic.preloads.at(0).find("poly")->parameters, stage1_truth(plain));
  const DynamicResult dynamic = fit_dynamic(bench.logs(), elastic, {});
  add(tables, "2 ", dynamic.preloads.at(0).fits.at(0).parameters, stage2_truth(plain));
}

TEST_CASE("intervals of coupled joints cover the truth", "[recover][monte-carlo]") {
  const unsigned n_runs = full_monte_carlo() ? 150 : 12;
  const PlainRig plain = three_coupled_cables();
  const TempFolder folder;
  const Rig rig = read_rig(folder.write("rig.json", rig_text(plain, "")));
  Tables tables;
  for (unsigned seed = 1; seed <= n_runs; ++seed) run(plain, rig, seed, tables);
  RunTable::print_header("  two joints, three coupled cables");
  double inside = 0, n = 0;
  for (const auto& [name, table] : tables) {
    table.print();
    inside += static_cast<double>(table.inside_interval);
    n += table.n();
    INFO(name);
    // The chance of scatter (chi of n - 1) beyond these, sd being right, is under 1e-4.
    CHECK(table.mean_sd() / table.scatter() > (full_monte_carlo() ? 0.75 : 0.45));
  }
  const double share = inside / n;
  std::printf("    inside their 95 %% interval: %.1f %%\n", 100 * share);
  // 95 % less 3.3 standard errors of a binomial. Parameters of one run are correlated: three count
  // as one.
  CHECK(share > 0.95 - 3.3 * std::sqrt(0.95 * 0.05 / (n / 3)));
}

}  // namespace
}  // namespace cablefit::test
