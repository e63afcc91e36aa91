#include "tests/report/results.hpp"

namespace cablefit::test {
namespace {

const std::string kSha(64, 'a');

ElasticFit linear_fit() {
  ElasticFit fit;
  fit.model = "linear";
  fit.parameters = {estimate("K", "N m/rad", 1819.2, 40), estimate("offset", "N m", 0.7, 1.4)};
  fit.transmission.linear_stiffness = Eigen::VectorXd::Constant(1, 1819.2);
  fit.transmission.theta_0 = Eigen::VectorXd::Zero(1);
  fit.offset = 0.7;
  fit.covariance = Eigen::MatrixXd::Constant(1, 1, 1600);
  fit.rms_error = 8.06;
  fit.max_abs_error = 16.3;
  fit.held_out_rms = 8.62;
  fit.held_out_max = 19.3;
  fit.condition = 3.5;
  fit.effective_rows = 12;
  return fit;
}

ElasticFit poly_fit(int order_1, int order_2) {
  ElasticFit fit;
  fit.model = "poly";
  fit.order = std::max(order_1, order_2);
  fit.transmission = antagonist_pair(fit.order);
  fit.transmission.cables[0].order = order_1;
  fit.transmission.cables[1].order = order_2;
  for (Cable& cable : fit.transmission.cables) {
    double value = 1367.7 + 1.0 / 3;  // needs all 17 digits
    for (int k = 0; k < cable.n_coefficients(); ++k, value *= 27.7) {
      cable.coefficients.push_back(value);
      fit.parameters.push_back(estimate(coefficient_name(cable, k, false),
                                        coefficient_unit(*cable.law, k, false), value, 1.1));
    }
  }
  const auto n = static_cast<Eigen::Index>(fit.parameters.size());
  fit.covariance = Eigen::MatrixXd::Identity(n, n) / 3 + Eigen::MatrixXd::Constant(n, n, 1e-7);
  fit.transmission.theta_0 = Eigen::VectorXd::Constant(1, 0.0012345678901234567);
  fit.parameters.push_back(estimate("theta_0", "rad", fit.transmission.theta_0(0), 1e-5));
  fit.parameters.push_back(estimate("f_sm", "N m", 2.79, 0.0068));
  fit.rms_error = 0.072;
  fit.max_abs_error = 0.508;
  fit.held_out_rms = 0.0745;
  fit.held_out_max = 0.506;
  fit.condition = 41.5;
  fit.effective_rows = 420;
  fit.warnings = {"cable 1 would push"};
  fit.passive = false;
  return fit;
}

Estimate unknown(Estimate e, const std::string& why) {
  e.not_identifiable = why;
  return e;
}

Estimate at_bound(Estimate e) {
  e.value = 0;
  e.active_bound = e.name + " >= 0";
  e.ci_low = 0;
  e.ci_high = 0.12;
  return e;
}

FitProof proof() {
  FitProof proof;
  proof.n_runs = 100;
  proof.n_failed = 2;
  proof.first_failure = "the simulated loop of low/moving.csv diverged";
  proof.seed = 7;
  proof.verdict = "the intervals of f_v are too narrow and were widened";
  proof.notes = {"controller: the rig's, with the reference of the log"};
  proof.parameters = {{"J_link", "kg m^2", 0.339, 0.0004, 0.0001, 0.001, 0.0011, 98, 94,
                       share_band(94, 98), 1, "covers"},
                      {"f_v", "N m s/rad", 5.6, -0.3, 0.04, 0.4, 0.2, 98, 70, share_band(70, 98),
                       2.1, "too narrow, sd times 2.10; biased by -1.5 sd"}};
  return proof;
}

DynamicFit dynamic_fit(const std::string& model, const ElasticFit& elastic) {
  DynamicFit fit;
  fit.model = model;
  fit.estimator = "wls";
  Estimate j_link = estimate("J_link", "kg m^2", 0.339, 0.0146);
  j_link.symbol = "J_M";
  j_link.cad = 0.3;
  fit.parameters = {j_link, estimate("f_v", "N m s/rad", 5.601, 0.42),
                    estimate("f_s", "N m", 3.274, 0.21)};
  fit.torque_error["link"] = {0.183, 0.65, 0.0139};
  fit.torque_error["motor"] = {0.173, 0.731, 0.0458};
  fit.weight = {{"link", 29.9}, {"motor", 33.4}};
  fit.condition = {{"link", 82}, {"motor", 231}};
  fit.effective_rows = {{"link", 12634}, {"motor", 5470}};
  fit.elastic = elastic;
  fit.verdicts = {{"J_link", "identified"}, {"f_v", "identified"}, {"f_s", "identified"}};
  if (model == "poly") fit.proof = proof();
  return fit;
}

}  // namespace

Estimate estimate(const std::string& name, const std::string& unit, double value, double sd) {
  Estimate e;
  e.name = e.symbol = name;
  e.unit = unit;
  e.value = value;
  e.sd = sd;
  e.sd_white = sd / 4;
  e.ci_low = value - 2 * sd;
  e.ci_high = value + 2 * sd;
  return e;
}

ElasticPreload elastic_preload(const std::string& name, int order_1, int order_2) {
  ElasticPreload preload;
  preload.name = name;
  preload.deflection_low = -0.0445;
  preload.deflection_high = 0.1 / 3;
  preload.peak_torque = 138;
  preload.loop_half_width = 2.79;
  preload.counts = {900, 90, 3, 200};
  preload.modes = {100, {{"1", 420}, {"2", 380}}};
  preload.windows = {20000, 7, 5, 2};
  preload.fits = {linear_fit(), poly_fit(order_1, order_2)};
  preload.selected = "poly";
  preload.selection = {"materiality: poly"};
  preload.decisions = {{"cut-off", "10 Hz", "quasi-static"}, {"rest speed", name, "given"}};
  preload.warnings = {"theta moves in one direction only"};
  return preload;
}

ElasticResult elastic_result() {
  ElasticResult result;
  result.inputs = {{"low/blocked.csv", kSha, 20000}};
  result.preloads = {elastic_preload("low", 2, 2), elastic_preload("high", 2, 1)};
  return result;
}

DynamicPreload dynamic_preload(const std::string& name) {
  DynamicPreload preload;
  preload.name = name;
  preload.resonance = 76.2;
  preload.delay.seconds = 0.0005;
  preload.delay.sd = 2e-6;
  preload.delay.hold = 0.001;
  preload.delay.estimated = true;
  preload.delay.held = true;
  preload.delay.reason = "half a hold";
  preload.counts["link"] = {12634, 3344, 0, 44};
  preload.counts["motor"] = {8055, 7923, 0, 44};
  preload.windows = {32000, 0, 0, 2};
  const ElasticPreload stage1 = elastic_preload(name, 2, 2);
  preload.fits = {dynamic_fit("linear", stage1.fits[0]), dynamic_fit("poly", stage1.fits[1])};
  Estimate& f_v = preload.fits[1].parameters[1];
  f_v = unknown(f_v, "is not separable from f_s in these logs");
  preload.fits[1].parameters[2] = at_bound(preload.fits[1].parameters[2]);
  preload.decisions = {{"cut-off", "190 Hz", "2.5 f0"}};
  return preload;
}

DynamicResult dynamic_result() {
  DynamicResult result;
  result.inputs = {{"low/moving.csv", kSha, 32000}};
  result.preloads = {dynamic_preload("low"), dynamic_preload("high")};
  result.warnings = {"a warning"};
  return result;
}

}  // namespace cablefit::test
