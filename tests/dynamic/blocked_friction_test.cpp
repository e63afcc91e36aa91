// Dry friction of the motor in the blocked log against that in motion: what stage 2 says of it.
#include <catch2/catch.hpp>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// The warnings about f_sm, with that of stage 1 multiplied by `factor`.
std::vector<std::string> warnings_with(double factor) {
  ElasticResult stage1 = fit_elastic(std::vector<LogSurvey>{shipped("low/blocked.csv")}, {});
  for (ElasticFit& fit : stage1.preloads.at(0).fits)
    for (Estimate& e : fit.parameters)
      if (e.name == "f_sm") e.value *= factor;
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = "wls";
  const std::vector<LogSurvey> moving = {shipped("low/moving_load30.csv"),
                                         shipped("low/moving_load-40.csv")};
  std::vector<std::string> found;
  const DynamicResult result = fit_dynamic(moving, stage1, options);
  for (const std::string& warning : result.preloads.at(0).warnings)
    if (warning.starts_with("f_sm is")) found.push_back(warning);
  return found;
}

}  // namespace

TEST_CASE("friction of a blocked motor that differs is warned about", "[dynamic]") {
  CHECK(warnings_with(1).empty());
  const std::vector<std::string> less = warnings_with(0.9), more = warnings_with(1.1);
  REQUIRE(less.size() == 1);
  CHECK(
      less[0].ends_with("sticks and slips has less friction on average; sweep faster or log "
                        "faster"));
  REQUIRE(more.size() == 1);
  CHECK(more[0].ends_with("check the torque hold; friction may also depend on speed"));
}
