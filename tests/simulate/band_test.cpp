// The 95 % band of a simulation: what the joint covariance of the parameters leaves open.
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/model/model_parameters.hpp"
#include "cablefit/model/principal_copies.hpp"
#include "cablefit/simulate/moved_simulations.hpp"
#include "tests/simulate/true_models.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

double value_of(const Model& model, const std::string& name) {
  for (const ModelParameter& p : model_parameters(model))
    if (p.name == name) return parameter_value(model, p);
  throw std::runtime_error("no parameter " + name);
}

/// A covariance with these sd, every pair correlated by `r`.
ParameterCovariance covariance_of(const std::vector<std::string>& names, const Eigen::VectorXd& sd,
                                  double r) {
  const Eigen::Index n = sd.size();
  Eigen::MatrixXd correlation = Eigen::MatrixXd::Constant(n, n, r);
  correlation.diagonal().setOnes();
  return {names, sd.asDiagonal() * correlation * sd.asDiagonal()};
}

TEST_CASE("the copies of a model add up to the covariance of its parameters", "[simulate]") {
  Model model = true_model("low");
  const std::vector<std::string> names = {"K1_1", "J_motor", "f_s", "J_link"};
  model.covariance = covariance_of(names, Eigen::Vector4d(900, 1e-4, 0.05, 2e-3), 0.6);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(4, 4);
  for (const MovedModel& copy : principal_copies(model)) {
    Eigen::VectorXd step(4);
    for (Eigen::Index k = 0; k < 4; ++k)
      step(k) = (value_of(copy.model, names[static_cast<std::size_t>(k)]) -
                 value_of(model, names[static_cast<std::size_t>(k)])) /
                copy.by;
    sum += step * step.transpose();
  }
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index j = 0; j < 4; ++j)
      // The values are rounded to 1e-16 of themselves, which are at most 1e3 sd.
      CHECK_THAT(
          sum(i, j) / std::sqrt(model.covariance.matrix(i, i) * model.covariance.matrix(j, j)),
          WithinAbs(i == j ? 1 : 0.6, 1e-9));
}

TEST_CASE("no copy has a friction or an inertia that cannot be", "[simulate]") {
  Model model = true_model("low");
  // Three times as uncertain as large, and tied together so that no axis is of one alone.
  model.covariance =
      covariance_of({"f_s", "J_link"},
                    3 * Eigen::Vector2d(value_of(model, "f_s"), value_of(model, "J_link")), 0.5);
  const std::vector<MovedModel> copies = principal_copies(model);
  CHECK(copies.size() == 2);
  for (const MovedModel& copy : copies) {
    CHECK(value_of(copy.model, "f_s") >= 0);
    CHECK(value_of(copy.model, "J_link") > 0);
  }
}

TEST_CASE("a model without a covariance has no band", "[simulate]") {
  CHECK(principal_copies(true_model("low")).empty());
  ReplayOptions options;
  options.band = true;
  const SimulatedPart part = simulate_shipped(true_model("low"), "low/blocked.csv", options);
  for (const SignalGap& gap : part.gaps) CHECK_FALSE(gap.band);
}

TEST_CASE("the band of a spring at rest is that of its stiffness", "[simulate]") {
  // theta = tau / K once the motor stands, so that sd(theta) = tau sd(K) / K^2; a copy at K + sd
  // gives tau sd / (K (K + sd)), less by sd / K.
  constexpr double kStiffness = 1000, kSd = 2, kTorque = 20;
  Model model = spring_joint({0.3, 5, 0}, {0.01, 6, 0, 0}, kStiffness);
  model.covariance = covariance_of({"K"}, Eigen::VectorXd::Constant(1, kSd), 0);
  SimulationInput input = quiet_input(1001, 1e-3);
  input.tau.setConstant(kTorque);
  SimulationOptions options;
  options.link_blocked = true;
  MovedSimulations moved(model, options, 1);
  moved.start(input);
  const SimulationBand band = moved.run(input, 1001, simulate(model, input, options));
  const double sd = kTorque * kSd / (kStiffness * kStiffness);
  CHECK_THAT(band.theta(1000, 0), WithinRel(kNormal975 * sd, 1.1 * kSd / kStiffness));
  CHECK_THAT(band.deflection(1000, 0), WithinRel(kNormal975 * sd, 1.1 * kSd / kStiffness));
  CHECK(band.q(1000, 0) == 0);
  CHECK(band.tau(1000, 0) == 0);
}

TEST_CASE("a band has the same bits for any number of threads", "[simulate]") {
  Model model = true_model("low");
  model.covariance = covariance_of({"J_link", "f_s", "K1_0"}, Eigen::Vector3d(3e-3, 0.05, 4), 0.3);
  ReplayOptions options;
  options.band = true;
  const SimulatedPart one = simulate_shipped(model, "low/moving_load30.csv", options);
  options.threads = 3;
  const SimulatedPart three = simulate_shipped(model, "low/moving_load30.csv", options);
  REQUIRE(one.gaps.size() == three.gaps.size());
  for (std::size_t k = 0; k < one.gaps.size(); ++k) {
    REQUIRE(one.gaps[k].band);
    CHECK(one.gaps[k].band->half_width > 0);
    CHECK(one.gaps[k].band->half_width == three.gaps[k].band->half_width);
    CHECK(one.gaps[k].band->inside == three.gaps[k].band->inside);
  }
}

TEST_CASE("the gap of a model that is off by an sd lies in its band", "[simulate]") {
  // The true model, with K2_0, of the cable that this load pulls, off by one of its sd: the band is
  // 1.96 times as wide as the gap, beside which the sensors' rounding is small.
  Model model = true_model("low");
  const double sd = 20;
  model.covariance = covariance_of({"K2_0"}, Eigen::VectorXd::Constant(1, sd), 0);
  for (const ModelParameter& p : model_parameters(model))
    if (p.name == "K2_0") set_parameter_value(model, p, parameter_value(model, p) + sd);
  ReplayOptions options;
  options.band = true;
  const SignalGap gap =
      gap_of(simulate_shipped(model, "low/moving_load30.csv", options), "deflection");
  REQUIRE(gap.band);
  CHECK(gap.rms > 2 * gap.noise);
  CHECK_THAT(gap.band->half_width, WithinRel(kNormal975 * gap.rms, 0.1));
  CHECK(gap.band->inside > 0.99);
}

}  // namespace
