// Result files: what is written is what is read, and what the schemas say.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read/dynamic_reader.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/check_json.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/report/results.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using nlohmann::json;
using test::message_of;
using test::TempFolder;

ElasticResult read_back(const ElasticResult& result) {
  const TempFolder folder;
  return read_elastic_result(folder.write("elastic.json", elastic_json(result)));
}

TEST_CASE("a result of stage 1 reads back bit by bit") {
  const ElasticResult written = test::elastic_result();
  const ElasticResult read = read_back(written);
  CHECK(elastic_json(read) == elastic_json(written));
  REQUIRE(read.preloads.size() == 2);
  const ElasticFit& poly = read.preloads[1].fits[1];
  const ElasticFit& original = written.preloads[1].fits[1];
  CHECK(poly.covariance == original.covariance);
  CHECK(poly.transmission.theta_0 == original.transmission.theta_0);
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK(poly.transmission.cables[c].order == original.transmission.cables[c].order);
    CHECK(poly.transmission.cables[c].coefficients == original.transmission.cables[c].coefficients);
  }
  CHECK(read.preloads[0].fits[0].transmission.linear_stiffness(0) == 1819.2);
  CHECK(read.preloads[0].fits[0].transmission.cables.empty());
  CHECK(read.preloads[0].counts.rows_at_rest == 90);
  CHECK(read.preloads[0].windows.rows_resampled == 7);
}

TEST_CASE("a result of stage 2 reads back bit by bit") {
  DynamicResult written = test::dynamic_result();
  written.preloads[0].fits[1].suspects.push_back({"link", "a.csv", "run 2", 1.5, 1.6, -4, 3});
  const std::string text = dynamic_json(written);
  const DynamicResult read = parse_dynamic_result(parse_json(text, "dynamic.json"));
  CHECK(dynamic_json(read) == text);
  CHECK(read.preloads[0].fits[1].elastic->transmission.cables[0].coefficients ==
        written.preloads[0].fits[1].elastic->transmission.cables[0].coefficients);
}

TEST_CASE("the estimates of a result can be read where its rig file is gone") {
  DynamicResult written = test::dynamic_result();
  written.preloads[0].rig_path = "gone.json";
  const JsonNode root = parse_json(dynamic_json(written), "dynamic.json");
  CHECK_THROWS_WITH(parse_dynamic_result(root), Catch::Matchers::Contains("no rig file"));
  const DynamicResult read = parse_dynamic_result(root, RigFiles::leave);
  CHECK(read.preloads[0].rig_path == "gone.json");
  CHECK(read.preloads[0].fits[1].parameters[0].value ==
        written.preloads[0].fits[1].parameters[0].value);
  CHECK(!read.preloads[0].fits[1].elastic);
}

TEST_CASE("results are as the schemas say") {
  CHECK(test::schema_errors("elastic", elastic_json(test::elastic_result())) == "");
  CHECK(test::schema_errors("dynamic", dynamic_json(test::dynamic_result())) == "");
}

TEST_CASE("the schema checker finds what is wrong") {
  json result = json::parse(dynamic_json(test::dynamic_result()));
  json& fit = result["preloads"][0]["fits"][0];
  fit["parameters"][0].erase("sd");
  fit["model"] = "cubic";
  fit["surprise"] = 1;
  result["preloads"][1]["load_inertia"] = "heavy";
  const std::string errors = test::schema_errors("dynamic", result.dump());
  CHECK_THAT(errors, Catch::Matchers::Contains("fits/0/parameters/0: sd is missing") &&
                         Catch::Matchers::Contains("fits/0/model: not among") &&
                         Catch::Matchers::Contains("fits/0: surprise is not allowed") &&
                         Catch::Matchers::Contains("preloads/1/load_inertia: wrong type"));
}

TEST_CASE("what the data cannot determine has no numbers that look like an uncertainty") {
  const json result = json::parse(dynamic_json(test::dynamic_result()));
  const json& f_v = result["preloads"][0]["fits"][1]["parameters"][1];
  for (const char* key : {"sd", "sd_white", "rsd_percent", "ci95"}) CHECK(f_v[key].is_null());
  CHECK(f_v["not_identifiable"] == "is not separable from f_s in these logs");
  CHECK(result["preloads"][0]["fits"][1]["parameters"][2]["active_bound"] == "f_s >= 0");
}

TEST_CASE("NaN and infinity are null") {
  ElasticResult result = test::elastic_result();
  result.preloads[0].fits[0].condition = std::numeric_limits<double>::infinity();
  result.preloads[0].fits[0].held_out_max = std::numeric_limits<double>::quiet_NaN();
  const json written = json::parse(elastic_json(result));
  CHECK(written["preloads"][0]["fits"][0]["condition"].is_null());
  CHECK(std::isnan(read_back(result).preloads[0].fits[0].held_out_max));
}

TEST_CASE("bytes that are no UTF-8 do not break a result") {
  ElasticResult result = test::elastic_result();
  result.inputs[0].path =
      "bl\xff"
      "cked.csv";
  CHECK_NOTHROW(json::parse(elastic_json(result)));
}

struct BadResult {
  const char* path;   ///< JSON pointer of what is replaced
  const char* value;  ///< empty: taken out
  const char* message;
};

TEST_CASE("a result that does not fit together is refused with its place") {
  const BadResult cases[] = {
      {"/schema", "\"cablefit/dynamic/1\"", "schema 'cablefit/dynamic/1' is not a stage-1 result"},
      {"/preloads", "[]", "no preloads; run `cablefit elastic` again"},
      {"/preloads/0/fits/0/covariance", "[[1, 2]]", "not a 1 x 1 matrix"},
      {"/preloads/0/fits/0/parameters/0/name", "\"k\"", "parameter 'K' is missing"},
      {"/preloads/0/fits/0/parameters/0/value", "\"stiff\"",
       "'preloads[0].fits[0].parameters[0].value'"},
      {"/preloads/0/fits/0/theta_0", "[0, 0]", "2 value(s), expected 1"},
      {"/preloads/0/fits/0/order", "1.5", "1.5 is not an order"},
      {"/preloads/0/selected", "\"cubic\"", "no fit of model 'cubic'"},
      {"/preloads/0/deflection_range", "[1]", "not a range"},
      {"/preloads/0/rig", "\"gone.json\"", "no rig file 'gone.json'"},
      {"/preloads/0/fits", "", "missing key 'fits'"},
      {"/preloads/0/counts/rows_read", "-1", "-1 is not a count"},
  };
  for (const BadResult& bad : cases) {
    json result = json::parse(elastic_json(test::elastic_result()));
    const json::json_pointer pointer(bad.path);
    if (*bad.value == '\0') {
      result[pointer.parent_pointer()].erase(pointer.back());
    } else {
      result[pointer] = json::parse(bad.value);
    }
    const TempFolder folder;
    const std::string path = folder.write("elastic.json", result.dump(1));
    const std::string message =
        message_of([&] { (void)read_elastic_result(path); }, folder.path().string());
    INFO(bad.path << ": " << message);
    CHECK(message.find(bad.message) != std::string::npos);
    CHECK(message.rfind("elastic.json:", 0) == 0);
  }
}

TEST_CASE("a result of stage 2 is a model") {
  DynamicResult result = test::dynamic_result();
  const Effect& inertia = find_base_effect("inertia", Side::motor);
  for (DynamicFit& fit : result.preloads[0].fits) {
    for (const Effect& effect : base_effects(Side::motor)) {
      for (const ParameterInfo& info : effect.parameters) {
        const double value = &effect == &inertia ? 0.0133 : 0.1;
        fit.parameters.push_back(
            test::estimate(std::string(info.name), std::string(info.unit), value, 1e-4));
      }
    }
  }
  const TempFolder folder;
  const std::string path = folder.write("dynamic.json", dynamic_json(result));
  std::string choice;
  const Model poly = read_model(path, "low", "poly", choice);
  CHECK(poly.transmission.cables[0].coefficients ==
        result.preloads[0].fits[1].elastic->transmission.cables[0].coefficients);
  CHECK(poly.transmission.theta_0 == result.preloads[0].fits[1].elastic->transmission.theta_0);
  const Model linear = read_model(path, "low", "linear", choice);
  CHECK(linear.transmission.linear_stiffness(0) == 1819.2);
}

}  // namespace
