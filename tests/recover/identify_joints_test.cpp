// One step for several joints, l_o of every cable searched: over seeds the intervals of all
// parameters cover the truth of simulations that share nothing with the library (plain_joints.hpp).
#include <map>
#include <random>

#include "cablefit/identify/identify.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "tests/recover/joints_truth.hpp"
#include "tests/support/monte_carlo.hpp"
#include "tests/support/recover.hpp"
#include "tests/support/tendon_rigs.hpp"

namespace cablefit::test {
namespace {

using Tables = std::map<std::string, RunTable>;

NamedValues identify_truth(const PlainRig& rig, const Rig& file) {
  NamedValues values;
  if (file.arm.is_coupled()) values = arm_truth(file);
  for (const PlainCable& cable : rig.cables) {
    for (std::size_t j = 0; j < cable.k.size(); ++j)
      values.emplace_back(fmt::format("k[{}]_{}", cable.name, j), cable.k[j]);
    values.emplace_back(fmt::format("l_o[{}]", cable.name), cable.l_o);
  }
  for (std::size_t j = 0; j < rig.n(); ++j)
    values.emplace_back(name_of(rig, "f_sm_blocked", j), rig.joints[j].f_sm);
  for (const auto& value : stage2_truth(rig)) values.push_back(value);
  return values;
}

std::vector<Estimate> all_of(const IdentifyResult& r) {
  std::vector<Estimate> all = r.parameters;
  const std::vector<Estimate>& own = r.preloads.at(0).parameters;
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

struct Outcome {
  double inside = 0, n = 0;
  double share() const { return inside / n; }
};

unsigned runs() { return full_monte_carlo() ? 20 : 3; }

/// The same rig moved otherwise: each seed has its own motion, and so its own rounding.
PlainRig moved_by(PlainRig rig, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> factor(0.85, 1.15);
  for (PlainJoint& joint : rig.joints)
    for (double* size : {&joint.sweep, &joint.sweep_rate, &joint.swing, &joint.load})
      *size *= factor(random);
  rig.load_noise = 0.02;
  return rig;
}

/// `arm`: of links that move each other.
Outcome cover(const char* title, const PlainRig& plain, const PlainArm* arm = nullptr) {
  const TempFolder folder;
  if (arm != nullptr) folder.write("arm.urdf", urdf_text(*arm, "arm"));
  const Rig rig = read_rig(folder.write("rig.json", rig_text(plain, arm ? kUrdfArm : "")));
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  Tables tables;
  for (unsigned seed = 1; seed <= runs(); ++seed) {
    Bench bench;
    bench.rig = rig;
    // Links held at a whole number of counts, as in serial_arms_test.cpp.
    const std::vector<double> at(plain.n(), 5000 * plain.quantum);
    const PlainRig own = moved_by(plain, seed);
    bench.add_text(blocked_log(own, at, 60, seed));
    bench.add_text(moving_log(own, 8, seed + 1000));
    const IdentifyResult r = identify(bench.logs(), options);
    CHECK(r.preloads.at(0).equilibrium < 1e-9);
    REQUIRE(r.preloads.at(0).model);
    CHECK(r.preloads.at(0).model->is_coupled() == (arm != nullptr));
    for (const Estimate& e : r.preloads.at(0).model->arm)
      CHECK(r.preloads.at(0).model->covariance.of({e.name, "k[pip]_0"}));
    for (const auto& [name, value] : identify_truth(plain, rig)) {
      RunTable& table = tables[name];
      table.name = name;
      table.truth = value;
      table.add(estimate(all_of(r), name));
    }
  }
  RunTable::print_header(title);
  Outcome outcome;
  for (const auto& [name, table] : tables) {
    table.print();
    outcome.inside += static_cast<double>(table.inside_interval);
    outcome.n += table.n();
  }
  std::printf("    inside their 95 %% interval: %.1f %% of %.0f\n", 100 * outcome.share(),
              outcome.n);
  return outcome;
}

/// Parameters of one run are correlated: four count as one.
double least_share(const Outcome& outcome) {
  return full_monte_carlo() ? 0.90 : 0.95 - 3.3 * std::sqrt(0.95 * 0.05 / (outcome.n / 4));
}

TEST_CASE("one step of a finger with four cables, l_o searched", "[recover][monte-carlo]") {
  const Outcome outcome = cover("  two joints, four cables", four_cable_finger());
  CHECK(outcome.share() > least_share(outcome));
  if (full_monte_carlo()) CHECK(outcome.share() < 0.985);
}

TEST_CASE("one step of a finger with levers of two angles", "[recover][monte-carlo]") {
  const Outcome outcome = cover("  two joints, four cables past guides", guided_finger());
  CHECK(outcome.share() > least_share(outcome));
  if (full_monte_carlo()) CHECK(outcome.share() < 0.985);
}

TEST_CASE("one step of a finger of three joints and four tendons", "[recover][monte-carlo]") {
  const Outcome outcome = cover("  three joints, four tendons", three_joint_finger());
  CHECK(outcome.share() > least_share(outcome));
  if (full_monte_carlo()) CHECK(outcome.share() < 0.985);
}

TEST_CASE("one step of a finger whose links move each other", "[recover][monte-carlo]") {
  if (!reads_urdf()) return;
  const PlainArm arm = phalanges();
  const Outcome outcome = cover("  two phalanges, four cables", four_cable_phalanges(), &arm);
  CHECK(outcome.share() > least_share(outcome));
  if (full_monte_carlo()) CHECK(outcome.share() < 0.985);
}

}  // namespace
}  // namespace cablefit::test
