// Stage 1 with l_o searched: both preloads give one pair of cables, which stage 2 takes from its
// result file as from any other.
#include "cablefit/identify/elastic_search.hpp"

#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/identify/simulated_rigs.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

TEST_CASE("stage 1 finds l_o of the shipped blocked logs", "[identify][recover]") {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv"), shipped("high/blocked.csv")};
  const ElasticResult r = fit_elastic_with_search(logs, {}, true);
  const truth::Rig truths[] = {truth::Rig::low(), truth::Rig::high()};
  REQUIRE(r.preloads.size() == 2);
  for (std::size_t j = 0; j < 2; ++j) {
    const ElasticFit& poly = *r.preloads[j].find("poly");
    NamedValues truth = elastic_truth(truths[j]);
    truth.emplace_back("l_o[1]", truths[j].cable_1.initial_elongation);
    truth.emplace_back("l_o[2]", truths[j].cable_2.initial_elongation);
    check_recovered(poly.parameters, truth, 3);
    CHECK(poly.covariance.rows() == 4);
    CHECK(std::abs(std::sqrt(poly.covariance(0, 0)) / estimate(poly.parameters, "K1_0").sd - 1) <
          1e-12);
    CHECK(r.preloads[j].find("linear") != nullptr);
  }
  CHECK(schema_errors("elastic", elastic_json(r)) == "");

  const TempFolder folder;
  const ElasticResult read = read_elastic_result(folder.write("elastic.json", elastic_json(r)));
  const std::vector<LogSurvey> moving = {shipped("high/moving_load30.csv"),
                                         shipped("high/moving_load-40.csv")};
  const DynamicResult stage2 = fit_dynamic(moving, read, {});
  check_recovered(stage2.preloads.at(0).fits.at(0).parameters, dynamic_truth(truth::Rig::high()),
                  3);
}

// One preload alone, no word of l_o: the curve itself says that both cables are taut at zero.
TEST_CASE("a preload that the curve shows is searched without being asked", "[identify]") {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv"), shipped("high/blocked.csv")};
  const ElasticResult r = fit_elastic_stage(logs, {}, ElongationMode::automatic);
  REQUIRE(r.preloads.size() == 2);
  CHECK(find_estimate(r.preloads[0].find("poly")->parameters, "l_o[1]") == nullptr);
  NamedValues truth = elastic_truth(truth::Rig::high());
  truth.emplace_back("l_o[1]", truth::Rig::high().cable_1.initial_elongation);
  truth.emplace_back("l_o[2]", truth::Rig::high().cable_2.initial_elongation);
  check_recovered(r.preloads[1].find("poly")->parameters, truth, 3);
  CHECK(r.preloads[1].shape_doubt.empty());

  const IdentifyResult joint = identify(std::span(logs).subspan(1), {});
  CHECK(find_estimate(joint.preloads.at(0).parameters, "l_o[1]") != nullptr);
}

// The more both cables are stretched, the further out one goes slack: the curve is as steep at a
// fifth of the sweep as at zero, and falls beyond.
TEST_CASE("a large preload is searched too, a small one not in vain", "[identify]") {
  for (const double l_o : {9e-3, 15e-3, 25e-3}) {
    INFO("l_o = " << l_o);
    const truth::Rig rig = stretched(l_o);
    Bench bench;
    bench.add(blocked_log(rig, 23));
    const ElasticPreload preload =
        fit_elastic_stage(bench.logs(), {}, ElongationMode::automatic).preloads.at(0);
    NamedValues truth = elastic_truth(rig);
    truth.emplace_back("l_o[1]", rig.cable_1.initial_elongation);
    truth.emplace_back("l_o[2]", rig.cable_2.initial_elongation);
    check_recovered(preload.find("poly")->parameters, truth, 3);
    CHECK(find_estimate(identify(bench.logs(), {}).preloads.at(0).parameters, "l_o[1]") != nullptr);
  }
  Bench bench;
  bench.add(blocked_log(truth::Rig::low(), 24));
  const ElasticPreload preload =
      fit_elastic_stage(bench.logs(), {}, ElongationMode::automatic).preloads.at(0);
  CHECK(find_estimate(preload.find("poly")->parameters, "l_o[1]") == nullptr);
}

TEST_CASE("a curve that is not that of the cables gives no intervals", "[identify]") {
  const std::vector<LogSurvey> logs = {shipped("high/blocked.csv")};
  const ElasticResult known = fit_elastic_stage(logs, {}, ElongationMode::known);
  CHECK(known.preloads.at(0).shape_doubt ==
        "the stiffness falls on both sides of zero, as with cables that are both taut there "
        "(preload)");
  const TempFolder folder;
  const ElasticResult read = read_elastic_result(folder.write("elastic.json", elastic_json(known)));
  const std::vector<LogSurvey> moving = {shipped("high/moving_load30.csv")};
  const DynamicResult stage2 = fit_dynamic(moving, read, {});
  for (const Estimate& e : stage2.preloads.at(0).fits.at(0).parameters)
    CHECK(e.not_identifiable.find("stage 1 does not describe the cables: the stiffness falls on "
                                  "both sides of zero") == 0);
}

// The errors of a stage are those of the coefficients that it reports, not of a fit to one preload.
TEST_CASE("errors of a search are those of its cables", "[identify]") {
  PreloadedBench bench;
  bench.add("low", blocked_log(truth::Rig::low(), 17));
  bench.add("high", blocked_log(truth::Rig::high(), 18));
  const ElasticResult found = fit_elastic_with_search(bench.logs(), {}, true);
  const IdentifyResult joint = identify(bench.logs(), {});
  for (std::size_t j = 0; j < 2; ++j) {
    const ElasticFit& poly = *found.preloads.at(j).find("poly");
    // The same rows and cables; offset and friction are fitted to them once more.
    CHECK_THAT(poly.rms_error, Catch::WithinRel(joint.preloads.at(j).equations.at(0).rms, 1e-4));
    ElasticOptions options;
    options.order = 2;
    options.preload = found.preloads[j].name;
    PreloadedBench known;
    known.rig.transmission = joint.preloads[j].transmission;
    known.add(options.preload, blocked_log(j == 0 ? truth::Rig::low() : truth::Rig::high(),
                                           17 + static_cast<std::uint64_t>(j)));
    const ElasticFit alone = *fit_elastic(known.logs(), options).preloads.at(0).find("poly");
    for (const Cable& cable : joint.preloads[j].transmission.cables)
      for (const double k : cable.coefficients) options.coefficients.push_back(k);
    const ElasticFit given = *fit_elastic(known.logs(), options).preloads.at(0).find("poly");
    CHECK(poly.max_abs_error == given.max_abs_error);
    CHECK(poly.max_abs_error != alone.max_abs_error);
    CHECK(given.rms_error > alone.rms_error);
    for (double& k : options.coefficients) k *= 1.1;
    CHECK(fit_elastic(known.logs(), options).preloads.at(0).find("poly")->rms_error >
          10 * given.rms_error);
  }
}

TEST_CASE("stage 1 refuses to name an l_o that no log tells", "[identify]") {
  truth::Rig rig = truth::Rig::low();
  rig.cable_1 = {{1900}, 0.03};
  rig.cable_2 = {{1700}, 0.057 / 1.7};
  PreloadedBench bench;
  bench.add("tight", blocked_log(rig, 5, 0.01));
  ElasticOptions options;
  options.order = 1;
  const std::string message =
      message_of([&] { fit_elastic_with_search(bench.logs(), options, true); });
  INFO(message);
  CHECK(message.starts_with("preload 'tight': l_o[1] is not separable from"));
  CHECK(message.find("determined is K1_0 + K2_0 = 3") != std::string::npos);
  CHECK(message.ends_with("move until cable 1 goes slack"));
}

}  // namespace
