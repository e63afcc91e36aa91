// One jaw of a surgical tool on a cable and a long shaft (O'Neill, Stephens, Kowalewski, RA-L
// 2018): slow sines against resistance. The inertial torques are smaller than the residual, and the
// torque depends on the path. cablefit must report both and print no inertia.
#include "tests/reference/shared_data.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const char* hz : {"0.1", "0.3", "0.5"})
    for (const char* load : {"10", "50", "100"})
      all.push_back(std::string("mis_tool_cable/tool4L4_f") + hz + "Hz_load" + load + ".csv");
  return all;
}

ElasticOptions still() {
  ElasticOptions options;
  options.still = true;
  return options;
}

TEST_CASE("the MIS tool gives no inertia", "[reference]") {
  for (const std::string& name : names()) {
    const std::string path = shared_file(name);
    if (path.empty()) return;
    const std::vector<LogSurvey> logs = {survey_file(path, default_rig())};
    INFO(name);
    DynamicOptions options;
    options.models = {"linear", "poly"};
    ElasticResult stage1;
    DynamicResult result;
    const std::string refusal = message_of([&] {
      stage1 = fit_elastic(logs, still());
      result = fit_dynamic(logs, stage1, options);
    });
    std::printf("  %s: %s\n", name.c_str() + 15, refusal.c_str());
    REQUIRE(result.preloads.size() == 1);
    CHECK(result.preloads[0].name == "default");
    for (const DynamicFit& fit : result.preloads[0].fits)
      for (const char* inertia : {"J_link", "J_motor"}) {
        const Estimate& e = estimate(fit.parameters, inertia);
        INFO(fit.model << ' ' << inertia << ' ' << e.value << " +- " << e.sd);
        CHECK_FALSE(e.not_identifiable.empty());
        CHECK(std::isnan(e.value));
        CHECK(std::isnan(e.sd));
      }
  }
}

TEST_CASE("no static friction explains the MIS tool", "[reference]") {
  std::vector<LogSurvey> logs;
  for (const std::string& name : names()) {
    const std::string path = shared_file(name);
    if (path.empty()) return;
    logs.push_back(survey_file(path, default_rig()));
  }
  const ElasticPreload preload = fit_elastic(logs, still()).preloads.at(0);
  print_all("  pooled", preload.warnings);
  CHECK(warns(preload.warnings, "no static friction explains this loop"));
  const DynamicResult stage2 = fit_dynamic(logs, fit_elastic(logs, still()), {});
  for (const char* inertia : {"J_link", "J_motor"})
    CHECK_FALSE(
        estimate(stage2.preloads.at(0).fits.at(0).parameters, inertia).not_identifiable.empty());
}

}  // namespace
