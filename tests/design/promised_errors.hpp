// Whether the errors that a plan promises are met by fits to logs of its motion.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include "cablefit/design/excitation/excitation_plan.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"

namespace cablefit::test {

/// Stage 1 without error: the model's cables.
inline ElasticResult exact_stage1(const Model& model) {
  ElasticFit fit;
  fit.model = "poly";
  fit.order = 2;
  fit.transmission = model.transmission;
  ElasticPreload preload;
  preload.name = "default";
  preload.deflection_low = -0.03;
  preload.deflection_high = 0.03;
  for (std::size_t k = 0; model.joints.size() > 1 && k < model.joints.size(); ++k) {
    ElasticJoint& joint = preload.joints.emplace_back();
    joint.deflection_low = preload.deflection_low;
    joint.deflection_high = preload.deflection_high;
  }
  preload.fits = {fit};
  ElasticResult result;
  result.preloads = {preload};
  return result;
}

/// The errors of fits, each divided by what the plan expects.
class PromisedErrors {
 public:
  /// Encoder noise in the accelerations biases wls, and `auto` accepts a bias below half an sd. The
  /// plan is without such a bias, and so is iv.
  PromisedErrors(const Model& model, const PlannedFit& plan, const char* estimator = "iv")
      : plan_(plan),
        stage1_(exact_stage1(model)),
        sums_(plan.parameters.size()),
        squares_(plan.parameters.size()) {
    options_.models = {"poly"};
    options_.estimator = estimator;
    options_.robust_sd = options_.residual_tests = false;
  }

  void add(const LogSurvey& log) {
    const std::vector<LogSurvey> logs = {log};
    const DynamicFit fit = fit_dynamic(logs, stage1_, options_).preloads.at(0).fits.at(0);
    for (std::size_t k = 0; k < plan_.parameters.size(); ++k) {
      const PlannedParameter& p = plan_.parameters[k];
      const Estimate* found = find_estimate(fit.parameters, p.name);
      REQUIRE(found != nullptr);
      const double error = (found->value - p.value) / p.error();
      sums_[k] += error;
      squares_[k] += error * error;
    }
    ++n_;
  }

  /// After 32 logs. The rms of one parameter is sqrt(chi^2 / 32), between 0.62 and 1.42 with 99.9 %
  /// (chi^2 tables); of n parameters together 1 +- 1 / sqrt(2 * 32 * n), 5 % for seven, so that
  /// 25 % is what was asked for and 5 sd.
  void check() const {
    REQUIRE(n_ == kLogs);
    double all = 0;
    for (std::size_t k = 0; k < squares_.size(); ++k) {
      const PlannedParameter& p = plan_.parameters[k];
      const double rms = std::sqrt(squares_[k] / n_);
      std::printf(
          "      %-11s %9.4g error %.3g = sd %.3g + floor %.3g (white %.3g; %.3g %%), met %.2f "
          "times (bias %.2f)\n",
          p.name.c_str(), p.value, p.error(), p.sd, p.floor, p.sd_white, 100 * p.relative, rms,
          sums_[k] / n_);
      INFO(p.name);
      CHECK(rms > 0.62);
      CHECK(rms < 1.42);
      all += squares_[k] / n_ / static_cast<double>(squares_.size());
    }
    std::printf("      all: %.2f\n", std::sqrt(all));
    CHECK(std::sqrt(all) > 0.75);
    CHECK(std::sqrt(all) < 1.25);
  }

  /// Mean error of a parameter.
  double bias(std::string_view name) const {
    for (std::size_t k = 0; k < sums_.size(); ++k)
      if (plan_.parameters[k].name == name) return sums_[k] / n_;
    return kUnbounded;
  }

  static constexpr int kLogs = 32;

 private:
  PlannedFit plan_;
  ElasticResult stage1_;
  DynamicOptions options_;
  std::vector<double> sums_, squares_;  ///< per parameter
  int n_ = 0;
};

}  // namespace cablefit::test
