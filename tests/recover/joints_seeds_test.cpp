// Over seeds: the intervals of cables that two joints share, and of both joints, cover the truth.
#include <map>
#include <random>

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

/// How a rig is driven. `more`: keys of its file; `held`: rad, of every joint of the blocked log.
struct Trial {
  PlainRig plain;
  std::string more = {};
  double held = 0, blocked = 60, moving = 20;  ///< s
  std::string estimator = "auto";
};

Rig rig_of(const Trial& trial, const TempFolder& folder) {
  if (const PlainArm* arm = trial.plain.link_dynamics.target<PlainArm>())
    folder.write("arm.urdf", urdf_text(*arm, "arm"));
  return read_rig(folder.write("rig.json", rig_text(trial.plain, trial.more)));
}

/// The rig with another swing of each joint. Rows of the links have no noise but that of the
/// encoders' steps, which is the same in two logs of one motion.
PlainRig moved_otherwise(PlainRig rig, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> factor(0.9, 1.1);
  for (PlainJoint& joint : rig.joints) joint.swing *= factor(random);
  return rig;
}

/// Both stages, n_runs times.
Tables run(const Trial& trial, unsigned n_runs) {
  const PlainRig& plain = trial.plain;
  const TempFolder folder;
  const Rig rig = rig_of(trial, folder);
  NamedValues moving = stage2_truth(plain);
  if (plain.link_dynamics)
    for (const auto& value : arm_truth(rig)) moving.push_back(value);
  const std::vector<double> at(plain.n(), trial.held);
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = trial.estimator;
  Tables tables;
  for (unsigned seed = 1; seed <= n_runs; ++seed) {
    Bench bench;
    bench.rig = rig;
    bench.add_text(blocked_log(plain, at, trial.blocked, seed));
    bench.add_text(moving_log(moved_otherwise(plain, seed), trial.moving, seed + 1000));
    const ElasticResult elastic = fit_elastic(bench.logs(), {});
    add(tables, "1 ", elastic.preloads.at(0).find("poly")->parameters, stage1_truth(plain));
    const DynamicResult dynamic = fit_dynamic(bench.logs(), elastic, options);
    add(tables, "2 ", dynamic.preloads.at(0).fits.at(0).parameters, moving);
  }
  return tables;
}

struct Inside {
  double share = 0, n = 0;
};

/// Prints the tables. Of all intervals together, those that hold the truth.
Inside inside_of(const char* title, const Tables& tables) {
  RunTable::print_header(title);
  Inside all;
  for (const auto& [name, table] : tables) {
    table.print();
    all.share += static_cast<double>(table.inside_interval);
    all.n += table.n();
  }
  all.share /= all.n;
  std::printf("    inside their 95 %% interval: %.1f %% of %g\n", 100 * all.share, all.n);
  return all;
}

/// 95 % less 3.3 standard errors of a binomial. Parameters of one run are correlated: three count
/// as one.
double least_share(const Inside& all) { return 0.95 - 3.3 * std::sqrt(0.95 * 0.05 / (all.n / 3)); }

TEST_CASE("intervals of coupled joints cover the truth", "[recover][monte-carlo]") {
  const Tables tables =
      run({three_coupled_cables(), "", 0.1, 60, 8}, full_monte_carlo() ? 150 : 12);
  const Inside all = inside_of("  two joints, three coupled cables", tables);
  for (const auto& [name, table] : tables) {
    INFO(name);
    // The chance of scatter (chi of n - 1) beyond these, sd being right, is under 1e-4.
    CHECK(table.mean_sd() / table.scatter() > (full_monte_carlo() ? 0.75 : 0.45));
  }
  CHECK(all.share > least_share(all));
}

/// 90 to 98 % of the intervals of twenty runs hold the truth. Joints are held at whole counts of
/// the encoder, as in serial_arms_test.cpp.
void check_coverage(const char* title, Trial trial) {
  trial.held = 10000 * trial.plain.quantum;
  const Inside all = inside_of(title, run(trial, full_monte_carlo() ? 20 : 1));
  CHECK(all.share >= (full_monte_carlo() ? 0.9 : least_share(all)));
  if (full_monte_carlo()) CHECK(all.share <= 0.98);
}

TEST_CASE("intervals of a finger with n + 1 tendons", "[recover][monte-carlo]") {
  check_coverage("  finger, 2 joints, 3 tendons; 60 s blocked, 20 s moving", {tendon_finger()});
}

TEST_CASE("intervals of a finger with 2n tendons", "[recover][monte-carlo]") {
  check_coverage("  finger, 2 joints, 4 tendons; 60 s blocked, 20 s moving", {paired_finger()});
}

TEST_CASE("intervals of a hand with two fingers", "[recover][monte-carlo]") {
  check_coverage("  hand, 6 joints, 10 tendons; 60 s blocked, 20 s moving", {two_finger_hand()});
}

TEST_CASE("intervals of an arm of seven joints", "[recover][monte-carlo]") {
  if (!reads_urdf()) return;
  check_coverage("  arm, 7 joints, 14 cables, URDF; 60 s blocked, 16 s moving",
                 {seven_joint_rig(), kUrdfArm, 0, 60, 16});
}

TEST_CASE("intervals of output error on links that move each other", "[recover][monte-carlo]") {
  if (!reads_urdf()) return;
  check_coverage("  finger by output error, 2 joints, 3 tendons, URDF; 60 s blocked, 20 s moving",
                 {phalanges_rig(), kUrdfArm, 0, 60, 20, "output-error"});
}

}  // namespace
}  // namespace cablefit::test
