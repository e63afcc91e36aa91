// The motion that is designed for links that move each other: what the plan promises is met on
// simulated logs, base parameters included.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "cablefit/design/excitation/excitation_plan.hpp"
#include "cablefit/design/excitation/planned_log.hpp"
#include "cablefit/samples/survey/recorded.hpp"
#include "tests/design/promised_errors.hpp"
#include "tests/simulate/arm_models.hpp"

namespace cablefit::test {
namespace {

Model phalanges_model() {
  const PlainRig plain = phalanges_rig();
  Model model =
      arm_model(plain, phalanges(),
                R"("controller": {"type": "pd", "kp": 6, "kd": 0.06, "reference": "theta_ref"},)");
  model.name = "poly";
  model.rig.sensors["q"].noise = model.rig.sensors["theta"].noise = 3e-6;
  model.rig.sensors["tau"].noise = 2e-3;
  return model;
}

ExcitationOptions options() {
  ExcitationOptions options;
  options.shape = "multisine";
  options.limits.max_position = 0.6;
  options.limits.max_speed = 4;
  options.limits.max_torque = 3;
  options.limits.duration = 8;
  options.n_random = 6;
  options.n_generations = 4;
  options.threads = 2;
  return options;
}

LogSurvey recorded(const LogSurvey& clean, const Window& window, std::uint64_t draw) {
  const Window noisy = with_noise(window, clean, draw);
  RecordedPart part{"default", "", Phase::moving, true, {}};
  part.rows.resize(noisy.data.rows(), noisy.data.cols() + 1);
  part.rows.rightCols(noisy.data.cols()) = noisy.data;
  for (Eigen::Index i = 0; i < part.rows.rows(); ++i)
    part.rows(i, 0) = static_cast<double>(i) * noisy.period;
  return survey_recorded(clean.plan, {part});
}

// Without it the torque of the integral would be gone at the first row, and the arm would fall.
TEST_CASE("an arm on an integral controller begins a motion at rest", "[design]") {
  Model model = phalanges_model();
  model.rig.controller->ki = 2;
  const ExcitationLimits limits = options().limits;
  SimulationOptions simulation;
  simulation.closed_loop = true;
  simulation.step = 1e-4;
  SimulationInput input = at_rest(model, limits, simulation.step);
  input.theta_ref = Eigen::ArrayXXd::Constant(20, 2, limits.middle);
  input.tau_load = Eigen::ArrayXXd::Constant(20, 2, limits.load);
  const SimulationResult r = simulate(model, input, simulation);
  REQUIRE(r.tau.row(0).abs().minCoeff() > 1e-2);  // what holds the arm's weight
  CHECK(r.qd.abs().maxCoeff() < 1e-3);
}

constexpr std::uint64_t kFirstDraw = 1000;  // none of the plan

TEST_CASE("the planned sd of an arm is met on simulated logs", "[design]") {
  const Model model = phalanges_model();
  const ExcitationPlan plan = plan_excitation(model, options(), false);
  std::printf("    worst error %.3g %%, plain sine of %.3g Hz %.3g %%; %d motions\n",
              100 * plan.fit.worst(), plan.plain.hz, 100 * plan.plain.worst, plan.n_tried);
  const SimulationResult& r = plan.motion.result;
  CHECK(r.q.abs().maxCoeff() <= plan.limits.max_position);
  CHECK(r.thetad.abs().maxCoeff() <= plan.limits.max_speed);
  CHECK(r.tau.abs().maxCoeff() <= plan.limits.max_torque);
  // Every base parameter is there, once.
  REQUIRE(plan.fit.parameters.size() == model.arm.size() + 2 * 2 + 4 * 2);
  for (std::size_t k = 0; k < model.arm.size(); ++k) {
    CHECK(plan.fit.parameters[k].name == model.arm[k].name);
    CHECK(plan.fit.parameters[k].value == model.arm[k].value);
    CHECK(plan.fit.parameters[k].equation == "links");
  }
  const LogSurvey clean = planned_log(model, plan.motion);
  const Window window = window_of(plan.motion, clean);
  PromisedErrors errors(model, plan.fit, "iv"), of_wls(model, plan.fit, "wls");
  for (std::uint64_t i = 0; i < PromisedErrors::kLogs; ++i) {
    const LogSurvey log = recorded(clean, window, kFirstDraw + i);
    errors.add(log);
    of_wls.add(log);
  }
  errors.check();
  // The mean of 32 errors has an sd of 0.18.
  CHECK(std::abs(errors.bias("YY1+0.01*M2")) < 0.6);
  CHECK(of_wls.bias("YY1+0.01*M2") < -1);
}

}  // namespace
}  // namespace cablefit::test
