// What each safeguard of stage 2 buys: switched off, the estimate must be visibly worse.
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

ElasticResult stage1() {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv")};
  return fit_elastic(logs, {});
}

DynamicFit stage2(const ElasticResult& elastic, DynamicOptions options) {
  options.estimator = "wls";  // the same one with and without the safeguard
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv"),
                                       shipped("low/moving_load-40.csv")};
  return fit_dynamic(logs, elastic, options).preloads.at(0).fits.at(0);
}

TEST_CASE("rows near reversals bias Coulomb friction when they are kept", "[dynamic]") {
  const ElasticResult elastic = stage1();
  const truth::Rig rig = truth::Rig::low();
  DynamicOptions all_rows;
  all_rows.samples.rest_speed = 0;
  const DynamicFit dropped = stage2(elastic, {});
  const DynamicFit kept = stage2(elastic, all_rows);
  for (const auto& [name, value] : NamedValues{{"f_s", rig.f_s}, {"f_sm", rig.f_sm}}) {
    const double with = estimate(dropped.parameters, name).value / value - 1;
    const double without = estimate(kept.parameters, name).value / value - 1;
    std::printf("  %-4s %+.3f %% with rest rows dropped, %+.3f %% with all rows\n", name.c_str(),
                100 * with, 100 * without);
    INFO(name);
    CHECK(std::abs(without) > 2 * std::abs(with));
    CHECK(std::abs(without) > 0.01);
  }
}

TEST_CASE("the covariance of stage 1 adds to that of stage 2", "[dynamic]") {
  ElasticResult elastic = stage1();
  const auto variances = [&](double factor) {
    ElasticResult scaled = elastic;
    for (ElasticFit& fit : scaled.preloads.at(0).fits) fit.covariance *= factor;
    std::vector<double> result;
    for (const Estimate& e : stage2(scaled, {}).parameters) result.push_back(e.sd * e.sd);
    return result;
  };
  const std::vector<double> none = variances(0), once = variances(1), much = variances(1e4);
  std::size_t matters = 0;
  for (std::size_t k = 0; k < none.size(); ++k) {
    INFO("parameter " << k);
    CHECK(once[k] > none[k]);
    // It adds linearly. Both differences carry the rounding of the larger variance, 1e-16 of it,
    // against a difference of 1e-4 of it or more: 1e-9 leaves three digits.
    CHECK_THAT((much[k] - none[k]) / 1e4,
               Catch::WithinRel(once[k] - none[k], 1e-9 * once[k] / (once[k] - none[k])));
    matters += once[k] > 1.05 * none[k];
  }
  CHECK(matters > 0);
}

TEST_CASE("white sd is asked for by option and is the paper's (25)", "[dynamic]") {
  const ElasticResult elastic = stage1();
  DynamicOptions white;
  white.robust_sd = false;
  const DynamicFit a = stage2(elastic, {});
  const DynamicFit b = stage2(elastic, white);
  for (std::size_t k = 0; k < a.parameters.size(); ++k) {
    // One column with the elastic torque instead of one per coefficient: rounding, no more.
    CHECK_THAT(a.parameters[k].value, Catch::WithinRel(b.parameters[k].value, 1e-12));
    CHECK(b.parameters[k].sd == b.parameters[k].sd_white);
    CHECK(a.parameters[k].sd > a.parameters[k].sd_white);
  }
}

}  // namespace
