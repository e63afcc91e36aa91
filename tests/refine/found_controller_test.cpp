// The controller of logs whose rig file names none.
#include "cablefit/session/found_controller.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <string>

#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

TEST_CASE("the controller of the shipped logs is found where the rig names none", "[refine]") {
  RefineLogs logs;
  logs.train = {shipped("low/moving_load30.csv")};
  logs.test = {shipped("low/moving_load-40.csv")};
  const Controller truth = logs.train[0].plan.rig.controller.value();
  std::vector<Model> models(1);
  models[0].rig = logs.train[0].plan.rig;
  CHECK_FALSE(take_found_controller(logs, models));

  for (auto* some : {&logs.train, &logs.test}) some->front().plan.rig.controller.reset();
  models[0].rig.controller.reset();
  const auto decision = take_found_controller(logs, models);
  REQUIRE(decision);
  CHECK(decision->name == "controller");
  for (const Rig* rig : {&logs.train[0].plan.rig, &logs.test[0].plan.rig, &models[0].rig}) {
    REQUIRE(rig->controller);
    CHECK(rig->controller->kp == Approx(truth.kp).epsilon(0.01));
    CHECK(rig->controller->kd == Approx(truth.kd).epsilon(0.02));
  }
}

TEST_CASE("controllers of a finger are found joint by joint", "[refine]") {
  PlainRig rig = tendon_finger();
  rig.logs_reference = true;
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  RefineLogs logs;
  logs.train = {bench.add_text(moving_log(rig, 10, 5))};
  std::vector<Model> models(1);
  models[0].rig = bench.rig;
  const auto decision = take_found_controller(logs, models);
  REQUIRE(decision);
  CHECK(decision->value.find("joint 1: kp ") == 0);
  CHECK(decision->value.find("; joint 2: kp ") != std::string::npos);
  REQUIRE(models[0].rig.controller);
  for (std::size_t joint = 0; joint < rig.n(); ++joint) {
    const Controller& own = models[0].rig.controller->of(joint);
    CHECK(own.kp == Approx(rig.joints[joint].kp).epsilon(0.01));
    CHECK(own.kd == Approx(rig.joints[joint].kd).epsilon(0.02));
  }
}

/// The header and every tenth row.
std::string every_tenth(const std::string& log) {
  std::istringstream lines(log);
  std::string line, thinned;
  for (int i = -1; std::getline(lines, line); ++i)
    if (i < 0 || i % 10 == 0) thinned += line + '\n';
  return thinned;
}

// A drive of 1 kHz logged at 100 Hz: the law found in it fits, but is unstable at that period.
TEST_CASE("a controller found in a slow log gives way to a surrogate", "[refine]") {
  PlainRig rig = three_coupled_cables();
  rig.logs_reference = true;
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  bench.add_text(blocked_log(rig, {0.1, 0.1}, 60, 11));
  bench.add_text(every_tenth(moving_log(rig, 20, 12)));
  const ElasticResult elastic = fit_elastic(bench.logs(), {});
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = "iv";
  const DynamicResult result = fit_dynamic(bench.logs(), elastic, options);
  const DynamicPreload& preload = result.preloads.at(0);
  const Estimate* motor = find_estimate(preload.fits.at(0).parameters, "J_motor[1]");
  REQUIRE(motor != nullptr);
  CHECK(motor->not_identifiable.empty());
  CHECK(std::any_of(preload.decisions.begin(), preload.decisions.end(), [](const Decision& d) {
    return d.reason.find("the controller found from the logs does not move the model") !=
           std::string::npos;
  }));
}

/// A slow sweep of the blocked link by a drive of stiffness `kp`.
std::string blocked_sweep(double kp) {
  std::string log = "t,q,theta,tau,theta_ref,phase\n";
  for (int i = 0; i < 12000; ++i) {
    const double t = 0.002 * i, w = 0.5, theta = 0.04 * std::sin(w * t);
    const double tau = 1400 * theta + (std::cos(w * t) > 0 ? 3 : -3);
    log += fmt::format("{:.3f},0,{:.7f},{:.4f},{:.7f},blocked\n", t, theta, tau, theta + tau / kp);
  }
  return log;
}

TEST_CASE("a blocked sweep with other gains is not of the controller found", "[refine]") {
  RefineLogs logs;
  logs.train = {shipped("low/moving_load30.csv")};
  const double kp = logs.train[0].plan.rig.controller.value().kp;
  logs.train[0].plan.rig.controller.reset();
  Bench bench;
  logs.blocked = {bench.add_text(blocked_sweep(kp)), bench.add_text(blocked_sweep(8 * kp))};
  std::vector<Model> models(1);
  REQUIRE(take_found_controller(logs, models));
  CHECK(logs.train[0].plan.rig.controller);
  CHECK(logs.blocked[0].plan.rig.controller);
  CHECK_FALSE(logs.blocked[1].plan.rig.controller);
}

}  // namespace
