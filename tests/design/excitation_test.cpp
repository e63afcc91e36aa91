// The motion that is designed: within its limits, better than a sine, and its planned sd is met.
#include "cablefit/design/excitation/excitation_plan.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "cablefit/base/random.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/samples/survey/recorded.hpp"
#include "tests/design/promised_errors.hpp"
#include "tests/simulate/benches.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// The shipped low rig: its sensors and its controller.
Model low_rig() {
  Model model = paper_rig_low();
  model.name = "poly";
  model.rig.torque_hold = TorqueHold::zoh;
  model.rig.sensors["q"].noise = 2e-6;
  model.rig.sensors["theta"].noise = 7e-6;
  model.rig.sensors["tau"].noise = 0.3;
  model.rig.controller.emplace();
  model.rig.controller->kp = 800;
  model.rig.controller->kd = 6;
  return model;
}

ExcitationOptions options_with(const std::string& shape) {
  ExcitationOptions options;
  options.shape = shape;
  options.limits.max_position = 0.5;
  options.limits.max_speed = 3;
  options.limits.max_torque = 100;
  options.limits.duration = 10;
  options.limits.load = 30;
  options.threads = 2;
  return options;
}

void check_limits(const ExcitationPlan& plan) {
  const SimulationResult& r = plan.motion.result;
  for (const Eigen::ArrayXXd* position : {&r.q, &r.theta, &plan.motion.theta_ref})
    CHECK(position->abs().maxCoeff() <= plan.limits.max_position);
  CHECK(r.qd.abs().maxCoeff() <= plan.limits.max_speed);
  CHECK(r.thetad.abs().maxCoeff() <= plan.limits.max_speed);
  CHECK(r.tau.abs().maxCoeff() <= plan.limits.max_torque);
}

/// What a recorder makes of the motion.
LogSurvey recorded(const Model& model, const ExcitationPlan& plan, Random& random) {
  RecordedPart part{"default", "", Phase::moving, true, {}};
  const SimulationResult& r = plan.motion.result;
  part.rows.resize(r.q.rows(), 6);
  const auto noisy = [&](const Eigen::ArrayXXd& x, double noise) -> Eigen::ArrayXd {
    Eigen::ArrayXd out = x.col(0);
    for (double& value : out) value += noise * random.normal();
    return out;
  };
  part.rows.col(1) = noisy(r.q, 2e-6);
  part.rows.col(2) = noisy(r.theta, 7e-6);
  for (Eigen::Index i = 0; i < r.q.rows(); ++i) {
    part.rows(i, 0) = static_cast<double>(i) * plan.motion.period;
    part.rows(i, 3) = r.tau(i, 0) + 0.3 * random.normal();
    part.rows(i, 4) = plan.motion.input.tau_load(i, 0);
    part.rows(i, 5) = plan.motion.theta_ref(i, 0);
  }
  return survey_recorded(recorded_plan("recorded", model.rig,
                                       {Channel::q, Channel::theta, Channel::tau, Channel::tau_load,
                                        Channel::theta_ref}),
                         {part});
}

TEST_CASE("the planned sd is met on simulated logs, and a plain sine is beaten", "[design]") {
  const Model model = low_rig();
  for (const MotionShape& shape : motion_shapes()) {
    const auto start = std::chrono::steady_clock::now();
    const ExcitationPlan plan =
        plan_excitation(model, options_with(std::string(shape.name)), false);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf(
        "    %s: worst error %.3g %%; plain sine of %.3g Hz %.3g %% (factor %.2f), best sine "
        "of %.3g Hz %.3g %% (factor %.2f); %d motions in %.1f s\n",
        plan.shape.c_str(), 100 * plan.fit.worst(), plan.plain.hz, 100 * plan.plain.worst,
        plan.factor(), plan.best.hz, 100 * plan.best.worst, plan.factor_of_best(), plan.n_tried,
        seconds.count());
    check_limits(plan);
    CHECK(plan.fit.refused.empty());
    CHECK_FALSE(plan.plain.fit.refused.empty());  // one sine does not determine an inertia
    if (shape.starts != nullptr) CHECK(plan.factor() > 1.2);
    Random random(9301);
    PromisedErrors errors(model, plan.fit);
    for (int i = 0; i < PromisedErrors::kLogs; ++i) errors.add(recorded(model, plan, random));
    errors.check();
  }
}

TEST_CASE("a search is the same on any number of threads", "[design]") {
  ExcitationOptions options = options_with("trapezoid");
  options.limits.duration = 4;
  options.n_random = 4;
  options.n_generations = 2;
  std::string words;
  const Model model = excitable(low_rig(), 1000, words);
  // Any scalar of a motion serves as an objective.
  const ExcitationObjective objective = [](const ExcitedMotion& motion) {
    return -motion.result.thetad.square().mean();
  };
  const Excitation one = search_excitation(model, options, objective);
  options.threads = 3;
  const Excitation three = search_excitation(model, options, objective);
  CHECK(one.objective == three.objective);
  CHECK((one.motion.theta_ref == three.motion.theta_ref).all());
  options.seed = 2;
  CHECK(search_excitation(model, options, objective).objective != one.objective);
}

TEST_CASE("what cannot be planned is told", "[design]") {
  Model rig;
  rig.rig = default_rig();
  CHECK(message_of([&] { (void)plan_excitation(rig, options_with("multisine"), false); }) ==
        "a rig file has no inertias: an excitation needs a model file or a result of "
        "'cablefit dynamic', or CAD values in a model file");
  Model deaf = low_rig();
  deaf.rig.sensors.erase("theta");
  CHECK(message_of([&] { (void)plan_excitation(deaf, options_with("multisine"), false); }) ==
        "the noise of sensor theta is unknown; add \"sensors\": {\"theta\": {\"quantum\": "
        "...}} to the rig; the expected sd need it");
  ExcitationOptions weak = options_with("multisine");
  weak.limits.max_torque = 3;  // dry friction alone takes 6
  weak.n_random = 4;
  CHECK(message_of([&] { (void)plan_excitation(low_rig(), weak, false); }) ==
        "no multisine of 10 s within 0.5 rad, 3 rad/s and 3 N m determines every "
        "parameter; raise a limit (load and friction alone may need all of the "
        "torque), or raise --duration");
  CHECK(message_of([&] { (void)plan_excitation(low_rig(), options_with("sine"), false); }) ==
        "unknown shape 'sine'; known: multisine, trapezoid");
  ExcitationOptions hurried = options_with("multisine");
  hurried.limits.duration = 0.1;
  CHECK(message_of([&] { (void)plan_excitation(low_rig(), hurried, false); }) ==
        "0.1 s are too short for a motion of this drive; it can be moved at up to 18 "
        "Hz (a third of its free resonance at rest, a fortieth of the sample rate): "
        "give --duration of at least 0.22");
}

}  // namespace
