// Over seeds: the intervals of cables that two joints share, and of both joints, cover the truth.
#include <map>

#include "cablefit/model/arm/urdf_file.hpp"
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

/// The rig as its file says it, for `more` keys.
Rig rig_of(const PlainRig& plain, const TempFolder& folder, const std::string& more) {
  if (!more.empty()) folder.write("arm.urdf", urdf_text(seven_joints(), "arm"));
  return read_rig(folder.write("rig.json", rig_text(plain, more)));
}

/// Both stages over seeds. Of all intervals together 90 to 98 % hold the truth.
void check_coverage(const char* title, const PlainRig& plain, const std::string& more,
                    double blocked, double moving) {
  const unsigned n_runs = full_monte_carlo() ? 20 : 1;
  const TempFolder folder;
  const Rig rig = rig_of(plain, folder, more);
  // Held at whole counts of the encoder, as in serial_arms_test.cpp.
  const std::vector<double> at(plain.n(), 10000 * plain.quantum);
  NamedValues links = stage2_truth(plain);
  if (plain.link_dynamics)
    for (const auto& value : arm_truth(rig)) links.push_back(value);
  Tables tables;
  for (unsigned seed = 1; seed <= n_runs; ++seed) {
    Bench bench;
    bench.rig = rig;
    bench.add_text(blocked_log(plain, at, blocked, seed));
    bench.add_text(moving_log(plain, moving, seed + 1000));
    const ElasticResult elastic = fit_elastic(bench.logs(), {});
    add(tables, "1 ", elastic.preloads.at(0).find("poly")->parameters, stage1_truth(plain));
    DynamicOptions options;
    options.models = {"poly"};
    const DynamicResult dynamic = fit_dynamic(bench.logs(), elastic, options);
    add(tables, "2 ", dynamic.preloads.at(0).fits.at(0).parameters, links);
  }
  RunTable::print_header(title);
  double inside = 0, n = 0;
  for (const auto& [name, table] : tables) {
    table.print();
    inside += static_cast<double>(table.inside_interval);
    n += table.n();
  }
  std::printf("    blocked %g s, moving %g s; inside their 95 %% interval: %.1f %% of %g\n",
              blocked, moving, 100 * inside / n, n);
  if (full_monte_carlo()) {
    CHECK(inside / n >= 0.9);
    CHECK(inside / n <= 0.98);
  } else {  // as above: parameters of one run are correlated, three count as one
    CHECK(inside / n > 0.95 - 3.3 * std::sqrt(0.95 * 0.05 / (n / 3)));
  }
}

TEST_CASE("intervals of a finger with n + 1 tendons", "[recover][monte-carlo]") {
  check_coverage("  finger, 2 joints, 3 tendons", tendon_finger(), "", 60, 20);
}

TEST_CASE("intervals of a finger with 2n tendons", "[recover][monte-carlo]") {
  check_coverage("  finger, 2 joints, 4 tendons", paired_finger(), "", 60, 20);
}

TEST_CASE("intervals of a hand with two fingers", "[recover][monte-carlo]") {
  check_coverage("  hand, 6 joints, 10 tendons", two_finger_hand(), "", 60, 20);
}

TEST_CASE("intervals of an arm of seven joints", "[recover][monte-carlo]") {
  if (!reads_urdf()) return;
  check_coverage("  arm, 7 joints, 14 cables, URDF", seven_joint_rig(), kUrdfArm, 60, 16);
}

}  // namespace
}  // namespace cablefit::test
