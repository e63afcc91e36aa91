// What follows from several parameters: stiffness at rest, resonance, damping, dry friction, with
// sd by the delta method from the joint covariance.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "cablefit/dynamic/estimates/joint_estimates.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/recorded_log.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

struct Truth {
  double stiffness, f_0, zeta, f_dry;
};

/// Of the paper's low rig (Table 1 and 2), by the formulas of joint_estimates.hpp.
Truth truth_of_low() {
  const auto elastic = elastic_truth(truth::Rig::low());
  const auto dynamic = dynamic_truth(truth::Rig::low());
  const auto value = [](const auto& list, const std::string& wanted) {
    for (const auto& [name, v] : list)
      if (name == wanted) return v;
    FAIL(wanted);
    return 0.0;
  };
  const double k = 0.5 * (value(elastic, "K1_0") + value(elastic, "K2_0"));
  const double a = 1 / value(dynamic, "J_link"), b = 1 / value(dynamic, "J_motor");
  const double omega = std::sqrt(k * (a + b));
  const double rate = (value(dynamic, "f_v") * a * a + value(dynamic, "f_vm") * b * b) / (a + b);
  return {k, omega / (2 * std::numbers::pi), rate / (2 * omega),
          value(dynamic, "f_s") + value(dynamic, "f_sm")};
}

DynamicFit fit_low(const std::string& estimator, const ElasticResult& stage1) {
  DynamicOptions options;
  options.estimator = estimator;
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv"),
                                       shipped("low/moving_load-40.csv")};
  return fit_dynamic(logs, stage1, options).preloads.at(0).fits.at(0);
}

// Four deviates of each of three estimators, most of them shared: 3.5 sd, as for the parameters.
TEST_CASE("derived quantities agree with the truth within their sd", "[dynamic]") {
  ElasticOptions options;
  options.order = 2;
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  const ElasticResult stage1 = fit_elastic(blocked, options);
  const Truth truth = truth_of_low();
  for (const char* estimator : {"wls", "iv", "output-error"}) {
    const DynamicFit fit = fit_low(estimator, stage1);
    INFO(estimator);
    REQUIRE(fit.derived.size() == 4);
    check_recovered(fit.derived,
                    {{"K_rest", truth.stiffness},
                     {"f_0", truth.f_0},
                     {"zeta", truth.zeta},
                     {"f_dry", truth.f_dry}},
                    3.5);
    // d log f_0 = (d log K - J_link / (J_link + J_motor) d log J_motor - ...) / 2: at least half of
    // what J_motor alone makes, less what K takes back, at most half of all sizes together.
    const auto relative = [](const Estimate& e) { return e.sd / e.value; };
    const double most = 0.5 * (relative(estimate(fit.derived, "K_rest")) +
                               relative(estimate(fit.parameters, "J_motor")) +
                               relative(estimate(fit.parameters, "J_link")));
    const double f_0 = relative(estimate(fit.derived, "f_0"));
    CHECK(f_0 < most);
    CHECK(f_0 > 0.05 * most);
  }
}

// Cross terms count: with equations taken for independent the sd of a sum would be the root of the
// sum of squares. Both rows carry the same error e, so that x + y has sd 2, and x - y none.
TEST_CASE("equations that share their residual are correlated", "[dynamic]") {
  Normal normal(77);
  EquationInfluence one;
  one.cell_rows = 1;
  one.degrees_of_freedom = 200;
  one.influence.resize(200, 1);
  for (Eigen::Index i = 0; i < 200; ++i) {
    one.cells.push_back(i);
    one.influence(i, 0) = normal();
  }
  EquationInfluence two = one;
  one.names = {"x"};
  two.names = {"y"};
  DynamicFit fit;
  for (const char* name : {"x", "y"}) {
    Estimate e;
    e.name = name;
    e.value = 1;
    e.sd = 1;
    fit.parameters.push_back(e);
  }
  const auto sd_of_sum = [&](const std::vector<EquationInfluence>& parts, double sign) {
    const JointEstimates joint = join_estimates(fit, parts, nullptr);
    return derive({"s", "s", "", [sign](const Eigen::VectorXd& v) { return v(0) + sign * v(1); }},
                  joint)
        .sd;
  };
  CHECK(sd_of_sum({one, two}, 1) == Approx(2));
  CHECK(sd_of_sum({one, two}, -1) < 1e-6);
  two.cell_rows = 2;  // not the same stretches: nothing is known of the correlation
  CHECK(sd_of_sum({one, two}, 1) == Approx(std::sqrt(2.0)));
}

// d x / d K = 1 and -1: what an error of stage 1 does cancels in the sum.
TEST_CASE("both equations share the error of stage 1", "[dynamic]") {
  Normal normal(78);
  std::vector<EquationInfluence> parts(2);
  for (std::size_t k = 0; k < 2; ++k) {
    parts[k].names = {k == 0 ? "x" : "y"};
    parts[k].cell_rows = 1;
    parts[k].degrees_of_freedom = 500;
    parts[k].influence.resize(500, 1);
    parts[k].sensitivity = Eigen::MatrixXd::Constant(1, 1, k == 0 ? 1 : -1);
    for (Eigen::Index i = 0; i < 500; ++i) {
      parts[k].cells.push_back(i);
      parts[k].influence(i, 0) = normal();
    }
  }
  ElasticFit stage1;
  stage1.covariance = Eigen::MatrixXd::Constant(1, 1, 1.0);
  Estimate stiffness;
  stiffness.name = "K";
  stiffness.value = 100;
  stiffness.sd = 1;
  stage1.parameters = {stiffness};
  DynamicFit fit;
  for (const char* name : {"x", "y"}) {
    Estimate e;
    e.name = name;
    e.value = 1;
    e.sd = 1.01;  // nearly all of it stage 1's
    fit.parameters.push_back(e);
  }
  const JointEstimates joint = join_estimates(fit, parts, &stage1);
  REQUIRE(joint.names == std::vector<std::string>{"K", "x", "y"});
  const auto sd = [&](double k, double x, double y) {
    return derive({"s", "s", "",
                   [=](const Eigen::VectorXd& v) { return k * v(0) + x * v(1) + y * v(2); }},
                  joint)
        .sd;
  };
  const double own = std::sqrt(1.01 * 1.01 - 1);
  CHECK(sd(0, 1, 1) == Approx(std::sqrt(2.0) * own).epsilon(0.25));  // correlation of 500 deviates
  CHECK(sd(0, 1, -1) == Approx(std::hypot(2, std::sqrt(2.0) * own)).epsilon(0.03));
  CHECK(sd(-1, 1, 0) == Approx(own));
}

}  // namespace
