// Issue 8's acceptance for serial arms: a finger of two joints with coupled cables and an arm of
// seven, from their URDFs; base parameters and the frictions of every joint within 3 sd of the
// truth of simulations that share nothing with the regressor.
#include <chrono>

#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "tests/recover/joints_truth.hpp"
#include "tests/support/plain_arm.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {
namespace {

constexpr double kLimit = 3;  // sd

struct Recovered {
  Rig rig;
  DynamicResult dynamic;
};

Recovered recover(const PlainRig& plain, const PlainArm& arm, double seconds, unsigned seed) {
  Bench bench;
  bench.folder().write("arm.urdf", urdf_text(arm, "arm"));
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(plain, kUrdfArm)));
  // Held at a whole number of counts: what an encoder at rest is off by, up to half a count, stage
  // 1 takes for an offset of K times that, 3 mN m here, and its sd cannot know.
  const std::vector<double> at(plain.n(), 10000 * plain.quantum);
  bench.add_text(blocked_log(plain, at, 100, seed));
  bench.add_text(moving_log(plain, seconds, seed + 1));
  const auto start = std::chrono::steady_clock::now();
  const ElasticResult elastic = fit_elastic(bench.logs(), {});
  check_recovered(elastic.preloads.at(0).find("poly")->parameters, stage1_truth(plain), kLimit);
  DynamicOptions options;
  options.models = {"poly"};
  Recovered out{bench.rig, fit_dynamic(bench.logs(), elastic, options)};
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("    both stages took %.1f s\n", took.count());
  const DynamicPreload& preload = out.dynamic.preloads.at(0);
  print_all("stage 2", preload.warnings);
  print_all("stage 2, poly", preload.fits.at(0).warnings);
  NamedValues truth = arm_truth(out.rig);
  for (const auto& value : stage2_truth(plain)) truth.push_back(value);
  check_recovered(preload.fits.at(0).parameters, truth, kLimit);
  return out;
}

TEST_CASE("a finger of two joints from its URDF", "[recover]") {
  if (!reads_urdf()) return;
  const Recovered got = recover(phalanges_rig(), phalanges(), 20, 31);
  const auto& parameters = got.dynamic.preloads.at(0).fits.at(0).parameters;
  for (const char* name : {"MX1+0.1*M2", "MZ1", "YY1+0.01*M2", "MX2", "MZ2", "YY2"})
    CHECK(estimate(parameters, name).cad == got.rig.cad.at(name));
}

TEST_CASE("an arm of seven joints from its URDF", "[recover]") {
  if (!reads_urdf()) return;
  const Recovered got = recover(seven_joint_rig(), seven_joints(), 16, 41);
  CHECK(got.rig.arm.base_parameters().size() == 43);
  // Simulated copies follow the motion: one whose arm falls gives 0.012 and 0.006.
  const auto& parameters = got.dynamic.preloads.at(0).fits.at(0).parameters;
  CHECK(estimate(parameters, "f_s[1]").sd < 0.002);
  CHECK(estimate(parameters, "f_s[2]").sd < 0.003);
}

}  // namespace
}  // namespace cablefit::test
