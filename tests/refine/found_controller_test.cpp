// The controller of logs whose rig file names none.
#include "cablefit/session/found_controller.hpp"

#include <catch2/catch.hpp>

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

}  // namespace
