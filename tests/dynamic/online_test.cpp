// Estimates that are updated with every row on the shipped logs: forgetful recursive least squares
// and the gradient against the direct answer, and what is refused.
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

DynamicPreload fitted(const char* estimator, double memory) {
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv"),
                                       shipped("low/moving_load-40.csv")};
  DynamicOptions options;
  options.estimator = estimator;
  options.memory = memory;
  return fit_dynamic(logs, fit_elastic(blocked, {}), options).preloads.at(0);
}

TEST_CASE("a forgetful estimate stays within its sd of the direct answer", "[dynamic]") {
  const DynamicPreload preload = fitted("gradient", 2);
  const DynamicFit& fit = preload.fits.at(0);
  REQUIRE(fit.traces.size() == 2);
  const RecursiveTrace &recursive = fit.traces[0], &gradient = fit.traces[1];
  CHECK(recursive.rule.method == "recursive");
  CHECK(gradient.rule.method == "gradient");
  CHECK(recursive.rule.memory == 2);
  CHECK(recursive.rule.forgetting > 0.9);
  CHECK(recursive.rule.forgetting < 1);
  CHECK((gradient.rule.step > 0 && gradient.rule.step < 1));
  CHECK(gradient.rule.slowest >= 2);
  REQUIRE(recursive.points.size() == gradient.points.size());
  // Both logs of 16 s, less the edges.
  CHECK_THAT(recursive.points.back().t, Catch::WithinAbs(32, 1.5));
  for (std::size_t i = 1; i < recursive.points.size(); ++i)
    CHECK(recursive.points[i].t > recursive.points[i - 1].t);
  for (std::size_t k = 0; k < recursive.names.size(); ++k) {
    const Estimate& e = fit.parameters[k];
    INFO(e.name << " = " << e.value << " +- " << e.sd);
    const OnlineEnd end = online_end(recursive, k, e);
    // Of 7 parameters none beyond 4 sd; a sd of 2 s of samples is larger than that of 32 s.
    CHECK(std::abs(end.difference) < 4);
    CHECK(end.sd >
          std::sqrt(e.sd * e.sd - fit.method_floor.at(e.name) * fit.method_floor.at(e.name)));
    CHECK(end.value == Approx(e.value).margin(4 * end.sd));
    CHECK(std::isfinite(online_end(gradient, k, e).value));
  }
  // The direct answer is that of wls.
  const DynamicFit direct = fitted("wls", 0).fits.at(0);
  for (const Estimate& e : direct.parameters)
    CHECK(estimate(fit.parameters, e.name).value == e.value);
}

TEST_CASE("the memory is said, with what it is worth", "[dynamic]") {
  const DynamicPreload preload = fitted("gradient", 0);
  const auto reason_of = [&](const char* name) {
    for (const Decision& decision : preload.decisions)
      if (decision.name == name) return decision.value + ": " + decision.reason;
    return std::string();
  };
  CHECK(reason_of("memory of the recursive estimate") == "all: every row counts the same");
  CHECK_THAT(reason_of("memory of the gradient"),
             Catch::Contains("a tenth of the logs") && Catch::Contains("of a bound of 2"));
}

TEST_CASE("a memory of fewer samples than parameters is refused", "[dynamic]") {
  CHECK_THAT(message_of([] { fitted("recursive", 0.002); }),
             Catch::StartsWith("--memory 0.002 is too short"));
}

}  // namespace
