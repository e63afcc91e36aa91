// Output error finds the parameters behind a log whose torque is noisy, with intervals that hold.
#include "cablefit/dynamic/output_error/output_error.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <map>

#include "tests/simulate/true_models.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

Eigen::ArrayXXd column(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

MeasuredStretch stretch_of(const truth::Log& log, double rate) {
  MeasuredStretch stretch;
  stretch.period = 1 / rate;
  stretch.q = column(log.q);
  stretch.theta = column(log.theta);
  stretch.tau = column(log.tau);
  stretch.tau_load = column(log.tau_load);
  return stretch;
}

truth::MovingOptions moving(double load, std::uint64_t seed) {
  truth::MovingOptions options;
  options.duration = 16;
  options.load = load;
  options.seed = seed;
  options.noise_tau = 0.5;
  return options;
}

/// Two logs of the low rig, one per load: both cables are used.
std::vector<MeasuredStretch> low_logs(std::uint64_t seed) {
  std::vector<MeasuredStretch> stretches;
  for (const double load : {-20.0, 20.0}) {
    const truth::MovingOptions options = moving(load, seed++);  // noise of its own
    stretches.push_back(
        stretch_of(truth::simulate_moving(truth::Rig::low(), options), options.rate));
  }
  return stretches;
}

OutputErrorOptions options_of_low() {
  OutputErrorOptions options;
  const truth::MovingOptions log;
  // Of a rounded value.
  options.position_sd = Eigen::Vector2d(log.quantum_q, log.quantum_theta) / std::sqrt(12.0);
  return options;
}

/// The true model with every parameter off, by what a user may bring.
Model off(Model model) {
  double sign = 1;
  for (const ModelParameter& p : model_parameters(model)) {
    if (p.kind == ParameterKind::elongation || p.kind == ParameterKind::encoder_zero) continue;
    set_parameter_value(model, p, (1 + 0.2 * sign) * parameter_value(model, p));
    sign = -sign;
  }
  return model;
}

std::map<std::string, double> true_values(const Model& model) {
  std::map<std::string, double> values;
  for (const ModelParameter& p : model_parameters(model))
    values[p.name] = parameter_value(model, p);
  return values;
}

double errors_in_sd(const Estimate& e, double truth) { return (e.value - truth) / e.sd; }

TEST_CASE("output error finds inertias, frictions and cables under torque noise", "[recover]") {
  const Model truth = true_model("low");
  const OutputErrorFit fit = fit_output_error(off(truth), low_logs(1), options_of_low());
  INFO(fit.message);
  CHECK(fit.converged);
  const auto values = true_values(truth);
  REQUIRE(fit.parameters.size() == 11);
  for (const Estimate& e : fit.parameters) {
    INFO(e.name << " = " << e.value << " +- " << e.sd);
    std::printf("  %-8s %12.6g +- %9.3g  true %12.6g  %+6.2f sd\n", e.name.c_str(), e.value, e.sd,
                values.at(e.name), errors_in_sd(e, values.at(e.name)));
    // Eleven normal deviates beyond 3.5 sd: 0.5 %. Beside it what rounded positions leave, whose
    // noise is not quite white: 1e-4 of a parameter.
    CHECK(std::abs(e.value - values.at(e.name)) < 3.5 * e.sd + 1e-4 * std::abs(e.value));
  }
  const double noise = moving(0, 0).noise_tau;
  CHECK(std::abs(fit.noise.force[1] / noise - 1) < 0.15);  // some 4000 rows, less those at rest
  CHECK(fit.noise.force[0] < 0.1 * noise);                 // nothing disturbs the link
  CHECK(std::abs(fit.correlation) < 0.05);
  std::printf("  force noise %.3g %.3g N m, rms %.3f, correlation %.3f, %d passes\n",
              fit.noise.force[0], fit.noise.force[1], fit.residual_rms, fit.correlation,
              fit.n_passes);
}

/// The trap: a simulation that takes the measured torque for the true one.
TEST_CASE("output error without torque noise in its model is biased", "[recover]") {
  const Model truth = true_model("low");
  OutputErrorOptions options = options_of_low();
  options.force_sd = Eigen::Vector2d::Zero();
  options.window = 0.2;
  const OutputErrorFit fit = fit_output_error(off(truth), low_logs(1), options);
  const Estimate* inertia = find_estimate(fit.parameters, "J_motor");
  REQUIRE(inertia != nullptr);
  std::printf("  without torque noise: J_motor %+.1f %%, residual %.0f times the encoders'\n",
              100 * (inertia->value / 0.0133 - 1), fit.residual_rms);
  CHECK(fit.residual_rms > 10);  // and it shows
  CHECK(std::abs(inertia->value / 0.0133 - 1) > 0.03);
}

TEST_CASE("output error gives the same bits on any number of threads", "[recover]") {
  const Model start = off(true_model("low"));
  OutputErrorOptions options = options_of_low();
  options.max_rounds = 2;
  options.max_iterations = 2;
  std::vector<MeasuredStretch> logs = low_logs(3);
  logs.pop_back();
  const OutputErrorFit one = fit_output_error(start, logs, options);
  options.threads = 3;
  const OutputErrorFit three = fit_output_error(start, logs, options);
  REQUIRE(one.parameters.size() == three.parameters.size());
  for (std::size_t k = 0; k < one.parameters.size(); ++k) {
    CHECK(one.parameters[k].value == three.parameters[k].value);
    CHECK(one.parameters[k].sd == three.parameters[k].sd);
  }
}

/// Stage 1 as rows of the fit: a prior much sharper than the data rules, a vague one does not.
TEST_CASE("a prior counts by its covariance", "[recover]") {
  const Model truth = true_model("low");
  OutputErrorOptions options = options_of_low();
  options.prior.names = {"K1_0"};
  options.prior.mean = Eigen::VectorXd::Constant(1, 1400.0);
  std::vector<MeasuredStretch> logs = low_logs(5);
  logs.pop_back();
  double value[2];
  const double sds[] = {1e-4, 1e4};
  for (int k = 0; k < 2; ++k) {
    options.prior.covariance = Eigen::MatrixXd::Constant(1, 1, sds[k] * sds[k]);
    const OutputErrorFit fit = fit_output_error(truth, logs, options);
    const Estimate* e = find_estimate(fit.parameters, "K1_0");
    REQUIRE(e != nullptr);
    value[k] = e->value;
    if (k == 0) CHECK_THAT(e->sd, Catch::WithinRel(1e-4, 0.01));
  }
  CHECK_THAT(value[0], Catch::WithinAbs(1400, 0.01));
  CHECK_THAT(value[1], Catch::WithinAbs(1367.7, 1.0));
}

TEST_CASE("output error that cannot be simulated says so and has no estimates", "[recover]") {
  Model stiff = true_model("low");
  for (Cable& cable : stiff.transmission.cables) cable.coefficients[0] *= 1e6;  // 5 h omega
  std::vector<MeasuredStretch> logs = low_logs(7);
  logs.pop_back();
  const OutputErrorFit fit = fit_output_error(stiff, logs, options_of_low());
  CHECK_FALSE(fit.converged);
  CHECK(fit.parameters.empty());
  CHECK(fit.message == "the simulation diverges where the fit starts");
}

/// The end must not depend on the start of the last rounds: all rows determine more than those of
/// the first rounds.
TEST_CASE("output error ends at the same estimates wherever it begins", "[recover]") {
  const Model truth = true_model("low");
  const std::vector<MeasuredStretch> logs = low_logs(1);
  OutputErrorOptions few = options_of_low();
  few.first_rows = 6000;
  const OutputErrorFit a = fit_output_error(off(truth), logs, options_of_low());
  const OutputErrorFit b = fit_output_error(truth, logs, few);
  REQUIRE(a.parameters.size() == b.parameters.size());
  for (std::size_t k = 0; k < a.parameters.size(); ++k) {
    const Estimate &x = a.parameters[k], &y = b.parameters[k];
    INFO(x.name << " " << x.value << " and " << y.value << " +- " << x.sd);
    // A round may end 0.2 sd from its minimum, and the noise levels are estimated there.
    CHECK(std::abs(x.value - y.value) < 0.3 * x.sd);
    CHECK_THAT(x.sd, Catch::WithinRel(y.sd, 0.1));
  }
}

}  // namespace
