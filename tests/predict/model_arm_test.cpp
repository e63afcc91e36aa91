// Links that move each other: torques follow from the arm of the model, not from that of the rig
// file beside the log.
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "cablefit/predict/predict.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// rms of the model minus the sensor, by signal.
std::map<std::string, double> gaps(const Model& model, const LogSurvey& log) {
  std::map<std::string, double> rms;
  const PredictResult result = predict_logs(model, {&log, 1}, {});
  for (const PredictedPart& part : result.parts)
    for (const SensedTorque& torque : part.torques) rms[torque.signal] = torque.rms;
  return rms;
}

std::string replaced_in(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

TEST_CASE("predictions have the arm of the model, not of the rig file", "[predict]") {
  if (!reads_urdf()) return;
  const std::string from = std::string(CABLEFIT_DATA) + "/two_joints/phalanges";
  const LogSurvey log = shipped("two_joints/phalanges/moving.csv");
  const ElasticResult stage1 =
      fit_elastic(std::vector<LogSurvey>{shipped("two_joints/phalanges/blocked.csv")}, {});
  DynamicOptions options;
  options.models = {"poly"};
  options.estimator = "wls";
  const TempFolder folder;
  std::string choice;
  const Model model = read_model(
      folder.write("dynamic.json", dynamic_json(fit_dynamic({&log, 1}, stage1, options))), "", "",
      choice);
  REQUIRE(model.is_coupled());
  const auto own = gaps(model, log);
  REQUIRE(own.size() == 4);
  // The same log beside an arm whose second phalanx hangs elsewhere, and beside none at all.
  const std::string urdf = content_of(from + "/finger.urdf"), rig = content_of(from + "/rig.json");
  folder.write("finger.urdf", replaced_in(urdf, R"(xyz="0.1 0 0")", R"(xyz="0.3 0 0")"));
  folder.write("other.json", rig);
  folder.write("plain.json",
               replaced_in(rig, R"("arm": {"type": "urdf", "file": "finger.urdf"},)", ""));
  for (const char* const file : {"other.json", "plain.json"}) {
    INFO(file);
    CHECK(gaps(model, survey_file(from + "/moving.csv", read_rig(folder.file(file)))) == own);
  }
}

}  // namespace
