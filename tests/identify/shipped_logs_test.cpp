// The shipped logs of both preloads in one fit: one pair of cables and two preloads (data/README.md
// says what is true), as the two stages found them but with smaller sd.
#include <cmath>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/results/read/identify_reader.hpp"
#include "cablefit/results/write/identify_json.hpp"
#include "tests/identify/simulated_rigs.hpp"
#include "tests/report/schema.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::vector<LogSurvey> shipped_logs(const std::vector<std::string>& preloads) {
  std::vector<LogSurvey> logs;
  for (const std::string& preload : preloads)
    for (const char* log : {"blocked", "moving_load30", "moving_load-40"})
      logs.push_back(shipped(preload + "/" + log + ".csv"));
  return logs;
}

// With robust sd a parameter leaves the band of 3 sd once in 370 tries; 24 are looked at.
TEST_CASE("one pair of cables and two preloads in the shipped logs", "[identify][recover]") {
  const std::vector<LogSurvey> logs = shipped_logs({"low", "high"});
  const IdentifyResult r = identify(logs, {});
  std::printf("identify, shipped logs\n");
  check_recovered(r.parameters, elastic_truth(truth::Rig::low()), 3);
  const truth::Rig truths[] = {truth::Rig::low(), truth::Rig::high()};
  for (std::size_t j = 0; j < 2; ++j) {
    const IdentifyPreload& p = r.preloads.at(j);
    std::printf("  %s\n", p.name.c_str());
    NamedValues truth = dynamic_truth(truths[j]);
    truth.emplace_back("l_o[1]", truths[j].cable_1.initial_elongation);
    truth.emplace_back("l_o[2]", truths[j].cable_2.initial_elongation);
    check_recovered(p.parameters, truth, 3);
    CHECK(p.equilibrium < 1e-9);
    // The same straight line through the model as through the data: the rest of the fit is white
    // enough to move it by less than a tenth of the line's own sd, which the curve dominates.
    REQUIRE(p.lines.size() == 1);
    const LineStiffness& line = p.lines.front();
    CHECK(std::abs(line.model - line.measured) < 0.1 * line.sd);
    CHECK(estimate(p.parameters, "l_o[1]").sd < 1e-5);
    CHECK(p.model.has_value());
  }
  // The truth has different inertias: 0.339 and 0.328, 0.0133 and 0.014.
  CHECK(warns(r.warnings, "inertias differ between preloads"));
  const std::string text = identify_json(r);
  CHECK(schema_errors("identify", text) == "");
  CHECK(identify_json(parse_identify_result(parse_json(text, "identify.json"))) == text);
}

TEST_CASE("any number of threads gives the same bits", "[identify]") {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv"), shipped("high/blocked.csv"),
                                       shipped("high/moving_load30.csv")};
  IdentifyOptions options;
  const std::string one = identify_json(identify(logs, options));
  for (const int threads : {2, 3}) {
    options.samples.threads = threads;
    CHECK(identify_json(identify(logs, options)) == one);
  }
}

// Each estimate of the two stages is one of the joint fit's equations alone: they differ by what
// the others add, which is less than 2 joint sd plus those of the stage. The joint sd are not
// larger: stage 2 has the cables of stage 1 alone, here both preloads determine them. J and
// frictions of the link rest on the same rows either way, and both sd come from one kernel
// (interval_covariance): 1 % for the weights.
TEST_CASE("one step agrees with the two stages and has smaller sd", "[identify]") {
  const std::vector<LogSurvey> logs = shipped_logs({"low"});
  IdentifyOptions options;
  const IdentifyResult joint = identify(logs, options);
  ElasticOptions elastic;
  elastic.order = 2;
  const ElasticResult stage1 = fit_elastic(logs, elastic);
  const DynamicResult stage2 = fit_dynamic(logs, stage1, {});
  const auto compare = [](const Estimate& one, const Estimate& two) {
    INFO(one.name << " joint " << one.value << " +- " << one.sd << ", stages " << two.value
                  << " +- " << two.sd);
    CHECK(std::abs(one.value - two.value) < 2 * std::hypot(one.sd, two.sd));
    // Stage 2 has instruments for the link, which keep the encoder's rounding out of the method's
    // floor of J_link; one step has none.
    CHECK(one.sd < (one.name == "J_link" ? 1.6 : 1.02) * two.sd);
  };
  for (const char* name : {"K1_0", "K1_1", "K2_0", "K2_1"})
    compare(estimate(joint.parameters, name),
            estimate(stage1.preloads[0].find("poly")->parameters, name));
  for (const char* name : {"J_link", "J_motor"})
    compare(estimate(joint.parameters, name),
            estimate(stage2.preloads[0].fits[0].parameters, name));
  for (const char* name : {"f_v", "f_s", "f_vm", "f_sm", "offset"})
    compare(estimate(joint.preloads[0].parameters, name),
            estimate(stage2.preloads[0].fits[0].parameters, name));
}

// What the rig file gives stands in the result with an sd of 0, and the rest is fitted around it.
TEST_CASE("an inertia that the rig gives is not fitted", "[identify]") {
  std::vector<LogSurvey> logs = shipped_logs({"low"});
  for (LogSurvey& log : logs) {
    log.plan.rig.arm.kind = &find_arm_kind("independent");
    log.plan.rig.arm.parameters.J_link = {0.35};
  }
  const IdentifyResult r = identify(logs, {});
  const IdentifyPreload& p = r.preloads.at(0);
  CHECK(find_estimate(r.parameters, "J_link") == nullptr);
  const Estimate& given = estimate(p.parameters, "J_link");
  CHECK(given.value == 0.35);
  CHECK(given.sd == 0);
  // 3 % too large an inertia takes its torque from the friction of the link.
  const Estimate& f_v = estimate(p.parameters, "f_v");
  CHECK(std::abs(f_v.value - truth::Rig::low().f_v) > f_v.sd);
  CHECK(estimate(r.parameters, "J_motor").value == Approx(truth::Rig::low().J_motor).epsilon(0.05));
  REQUIRE(p.model.has_value());
  CHECK(inertia_of(p.model->joints.at(0).link) == 0.35);
  CHECK(schema_errors("identify", identify_json(r)) == "");
}

}  // namespace
