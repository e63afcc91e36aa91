// What is drawn is what was fitted.
#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    if (!std::isnan(value)) most = std::max(most, std::abs(value));
  return most;
}

std::vector<const Figure*> titled(const DynamicPreload& preload, const std::string& title) {
  std::vector<const Figure*> all;
  for (const Figure& figure : preload.figures)
    if (figure.title == title) all.push_back(&figure);
  return all;
}

void check_whole(const DynamicPreload& preload) {
  for (const Figure& figure : preload.figures) {
    INFO(figure.group << ": " << figure.title);
    CHECK(!figure.traces.empty());
    for (const Trace& trace : figure.traces) CHECK(!trace.x.empty());
  }
}

TEST_CASE("figures of stage 2 show the residuals of both equations and models") {
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  const std::vector<LogSurvey> moving = {shipped("low/moving_load30.csv"),
                                         shipped("low/moving_load-40.csv")};
  const ElasticResult stage1 = fit_elastic(blocked, {});
  DynamicOptions options;
  options.models = {"linear", "poly"};
  options.figures = true;
  options.samples.threads = 2;
  const DynamicPreload low = fit_dynamic(moving, stage1, options).preloads.at(0);
  check_whole(low);
  const auto errors = titled(low, "Torque error over time");
  REQUIRE(errors.size() == 2);
  for (const Figure* figure : errors) {
    const std::string equation = figure->group.substr(0, figure->group.find(' '));
    CHECK(figure->marks.size() == 2);  // two logs
    REQUIRE(figure->traces.size() == 2);
    for (std::size_t m = 0; m < 2; ++m)
      CHECK_THAT(largest(figure->traces[m].y),
                 Catch::WithinRel(low.fits[m].torque_error.at(equation).max_abs, 1e-9));
  }
  CHECK(titled(low, "Torque error against load tau_load, poly").size() == 2);
  CHECK(titled(low, "Torque error against deflection theta - q, linear").size() == 2);
}

TEST_CASE("a rigid drive and a free oscillation have figures too") {
  const std::vector<LogSurvey> moving = {shipped("low/moving_load30.csv")};
  DynamicOptions options;
  options.models = {"rigid"};
  options.figures = true;
  const DynamicPreload rigid = fit_dynamic(moving, {}, options).preloads.at(0);
  check_whole(rigid);
  CHECK(titled(rigid, "Torque error over time").size() == 1);
  CHECK(titled(rigid, "Torque error against deflection theta - q, rigid").empty());
  options.models = {"ratios"};
  const DynamicPreload ratios = fit_dynamic(moving, {}, options).preloads.at(0);
  check_whole(ratios);
  CHECK(titled(ratios, "Acceleration error over time").size() == 1);
}

}  // namespace
