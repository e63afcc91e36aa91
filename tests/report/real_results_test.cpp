// Results of the repository's own data: as the schemas say, the same for any number of threads, and
// the same whether stage 1 comes from memory or from its file.
#include <catch2/catch.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/model/rig.hpp"
#include "cablefit/report/documents/check_document.hpp"
#include "cablefit/results/read/dynamic_reader.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "cablefit/results/write/check_json.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;

LogSurvey survey(const std::string& name) {
  const std::string path = CABLEFIT_DATA "/" + name;
  const Rig rig = rig_for_log(path, "");
  return survey_log(plan_log(path, rig), rig.preload);
}

ElasticResult stage1(int threads) {
  ElasticOptions options;
  options.order = 2;
  options.samples.threads = threads;
  const std::vector<LogSurvey> logs = {survey("low/blocked.csv")};
  return fit_elastic(logs, options);
}

DynamicResult stage2(const ElasticResult& elastic, int threads) {
  DynamicOptions options;
  options.models = {"linear", "poly"};
  options.samples.threads = threads;
  options.validation = {survey("low/moving_load-40.csv")};
  const std::vector<LogSurvey> logs = {survey("low/moving_load30.csv")};
  return fit_dynamic(logs, elastic, options);
}

TEST_CASE("real results are as the schemas say, whatever the number of threads") {
  const ElasticResult elastic = stage1(1);
  CHECK(test::schema_errors("elastic", elastic_json(elastic)) == "");
  CHECK(elastic_json(stage1(4)) == elastic_json(elastic));

  const std::string dynamic = dynamic_json(stage2(elastic, 1));
  CHECK(test::schema_errors("dynamic", dynamic) == "");
  CHECK(dynamic_json(stage2(elastic, 4)) == dynamic);

  CHECK(dynamic_json(parse_dynamic_result(parse_json(dynamic, "dynamic.json"))) == dynamic);

  const test::TempFolder folder;
  const ElasticResult read =
      read_elastic_result(folder.write("elastic.json", elastic_json(elastic)));
  CHECK(dynamic_json(stage2(read, 1)) == dynamic);
}

TEST_CASE("suspects, a sweep and a recursive fit are as the schema says") {
  DynamicOptions options;
  options.sweep = true;
  options.estimator = "robust";
  const std::vector<LogSurvey> logs = {survey("low/moving_load30.csv")};
  DynamicResult result = fit_dynamic(logs, stage1(1), options);
  result.preloads.at(0).fits.at(0).suspects.push_back({"link", "a.csv", "", 1.5, 1.6, -4, 3});
  const std::string json = dynamic_json(result);
  CHECK(test::schema_errors("dynamic", json) == "");
  CHECK(json.find("\"suspects\"") != std::string::npos);
  CHECK(json.find("\"sweep\"") != std::string::npos);
}

TEST_CASE("a check of real logs is as its schema says") {
  const std::vector<LogSurvey> logs = {survey("low/blocked.csv"), survey("low/moving_load30.csv")};
  const CheckResult result = check_logs(logs, {});
  CHECK(test::schema_errors("check", check_json(result)) == "");
  const std::vector<Prediction> predictions = predict_estimates(logs, result, {});
  REQUIRE(predictions.size() == 1);
  CHECK(predictions[0].equations.size() == 2);
  CHECK(test::schema_errors("check", check_json(result, predictions)) == "");
  SampleOptions threads;
  threads.threads = 4;
  CHECK(check_json(result, predict_estimates(logs, result, threads)) ==
        check_json(result, predictions));
  const Document document = check_document(result, predictions);
  std::size_t predicted = 0;
  for (const std::vector<std::string>& row : document.tidy.rows) {
    REQUIRE(row.size() == document.tidy.columns.size());
    if (row[15] != "J_motor") continue;  // log, preload, ..., equation, parameter, sd_at_best, ...
    ++predicted;
    CHECK(row[14] == "motor");
    CHECK(row[7] == "kg m^2");
    CHECK(std::stod(row[16]) > 0);
    CHECK(std::stod(row[18]) >= std::stod(row[16]));
    CHECK(row[21] != "not identifiable");
  }
  CHECK(document.tidy.columns[15].title == "parameter");
  CHECK(predicted == 1);
  CHECK(result.logs[0].parts[0].identifies == std::vector<std::string>{"elastic"});
  CHECK(result.logs[1].parts[0].identifies == std::vector<std::string>{"dynamic", "rigid"});
  CHECK(result.logs[1].parts[0].excitation.speed_bands > 3);
}

TEST_CASE("a check of several joints predicts every joint's equations") {
  const std::vector<LogSurvey> logs = {survey("two_joints/finger/moving.csv")};
  const CheckResult result = check_logs(logs, {});
  const std::vector<Prediction> predictions = predict_estimates(logs, result, {});
  REQUIRE(predictions.size() == 1);
  INFO(predictions[0].none);
  std::vector<std::string> names;
  for (const PredictedEquation& e : predictions[0].equations) {
    names.push_back(e.name);
    for (const PredictedParameter& p : e.parameters)
      CHECK(p.determined != Determined::not_identifiable);
  }
  CHECK(names == std::vector<std::string>{"link[1]", "motor[1]", "link[2]", "motor[2]"});
  CHECK(test::schema_errors("check", check_json(result, predictions)) == "");
}

}  // namespace
