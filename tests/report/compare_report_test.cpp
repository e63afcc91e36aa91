// What `compare` says of two results, in words and as JSON.
#include <catch2/catch.hpp>

#include "cablefit/campaign/compare/compare_json.hpp"
#include "cablefit/report/documents/compare_document.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/recorded_estimate.hpp"

namespace cablefit {
namespace {

using test::recorded_estimate;

RecordedResult result(const std::string& log, double friction) {
  RecordedResult r;
  r.path = log + ".json";
  r.command = "dynamic";
  r.version = log == "a" ? "1" : "2";
  r.inputs = {{log + ".csv", log, 10}};
  EstimateSet set{"stage 2", "low", "poly", "wls"};
  set.estimates = {recorded_estimate("f_s", friction, 0.1), recorded_estimate("f_v", 2, 0.01)};
  r.sets = {set};
  return r;
}

TEST_CASE("a comparison says what changed, and is as its schema says", "[compare]") {
  const RecordedResult a = result("a", 10), b = result("b", 12);
  const CompareResult r = compare(a, b, {});
  const Document document = compare_document(r);
  CHECK(document.summary.at(0).text == "1 of 2 parameters differ");
  CHECK(document.summary.at(1).text ==
        "f_s (dry friction on the link side): up 20 %, 10.00 -> 12.00 N m, 14 sd");
  CHECK(document.summary.at(2).text == "f_v");
  CHECK(document.summary.at(3).text == "made by: cablefit 1, then cablefit 2");
  const std::string json = compare_json(r, {{"a.json", std::string(64, '0'), 0}}, {"FAILED: x"});
  CHECK(test::schema_errors("compare", json) == "");
}

}  // namespace
}  // namespace cablefit
