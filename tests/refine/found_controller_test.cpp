// The controller of logs whose rig file names none.
#include "cablefit/session/found_controller.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

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
