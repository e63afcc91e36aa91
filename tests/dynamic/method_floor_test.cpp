// What coarse encoders do to estimates is in their sd, whatever the residual says.
#include <numbers>

#include "tests/support/recorded_log.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

DynamicFit fit_with(double quantum) {
  truth::MovingOptions options;
  options.duration = 12;
  options.load = 20;
  options.quantum_q = options.quantum_theta = quantum;
  Rig rig = default_rig();
  rig.torque_hold = TorqueHold::zoh;
  rig.sensors["q"].quantum = rig.sensors["theta"].quantum = quantum;
  const std::vector<LogSurvey> logs = {
      survey_of(truth::simulate_moving(truth::Rig::low(), options), rig)};
  ElasticResult stage1 = fit_elastic(std::vector<LogSurvey>{shipped("low/blocked.csv")}, {});
  stage1.preloads.front().name = "default";
  DynamicOptions fit;
  fit.estimator = "wls";
  fit.residual_tests = false;
  return fit_dynamic(logs, stage1, fit).preloads.at(0).fits.at(0);
}

TEST_CASE("the method's floor grows with the encoders' steps", "[dynamic]") {
  const DynamicFit fine = fit_with(6e-6), coarse = fit_with(2 * std::numbers::pi / (1 << 14));
  const auto floor_in_sd = [](const DynamicFit& fit, const char* name) {
    return fit.method_floor.at(name) / estimate(fit.parameters, name).sd;
  };
  INFO("J_link: " << floor_in_sd(fine, "J_link") << " and " << floor_in_sd(coarse, "J_link"));
  CHECK(coarse.method_floor.at("J_link") > 3 * fine.method_floor.at("J_link"));
  CHECK(floor_in_sd(coarse, "J_link") <= 1);  // it is part of the sd
  check_recovered(coarse.parameters, dynamic_truth(truth::Rig::low()), 3);
  check_recovered(fine.parameters, dynamic_truth(truth::Rig::low()), 3);
}

TEST_CASE("a known floor is taken as it is", "[dynamic]") {
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv")};
  const ElasticResult stage1 = fit_elastic(std::vector<LogSurvey>{shipped("low/blocked.csv")}, {});
  DynamicOptions options;
  options.estimator = "wls";
  options.method_floor.emplace();
  const DynamicFit without = fit_dynamic(logs, stage1, options).preloads.at(0).fits.at(0);
  const double sd = estimate(without.parameters, "J_link").sd;
  (*options.method_floor)["J_link"] = sd;
  const DynamicFit with = fit_dynamic(logs, stage1, options).preloads.at(0).fits.at(0);
  CHECK_THAT(estimate(with.parameters, "J_link").sd, Catch::WithinRel(std::sqrt(2.0) * sd, 1e-12));
}

}  // namespace
