// Logs of several joints whose columns are those of another joint.
#include "cablefit/samples/weigh/weigh.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// A shipped set with its rig file and this mapping of columns.
std::string weighed(const std::string& name, const std::string& columns) {
  const std::string from = std::string(CABLEFIT_DATA) + "/two_joints/" + name;
  const TempFolder folder;
  std::string rig = content_of(from + "/rig.json");
  rig.insert(1, R"("columns": {)" + columns + "}, ");
  folder.write("rig.json", rig);
  for (const char* const file : {"moving.csv", "finger.urdf"})
    folder.write(file, content_of(from + '/' + file));
  const std::string log = folder.file("moving.csv");
  return message_of(
      [&] {
        std::vector<LogSurvey> logs{survey_file(log, rig_for_log(log, ""))};
        weigh_logs(logs);
      },
      folder.path());
}

TEST_CASE("motors that follow the link of another joint are found", "[samples]") {
  const char* const links =
      R"("q1": "q2", "q2": "q1", "tau_load1": "tau_load2", "tau_load2": "tau_load1")";
  const char* const drives =
      R"("theta1": "theta2", "theta2": "theta1", "tau1": "tau2", "tau2": "tau1")";
  CHECK(weighed("finger", drives) ==
        "moving.csv: joints 1 and 2: are theta1 and theta2 swapped? theta1 and theta2 follow their "
        "own links with correlations of -0.15 and -0.16, swapped 1.00 and 0.98; exchange their "
        "columns in the rig file; if tau was recorded in the order of theta, or tau_load in that "
        "of q, exchange those too");
  CHECK(weighed("pairs", links) ==
        "moving.csv: joints 1 and 2: are q1 and q2 swapped? theta1 and theta2 follow their own "
        "links with correlations of -0.44 and 0.59, swapped 1.00 and 1.00; exchange their columns "
        "in the rig file; if tau was recorded in the order of theta, or tau_load in that of q, "
        "exchange those too");
  // The cables separate links and drives, although each swap alone mends one of two joints.
  CHECK(weighed("finger", links).find("are q1 and q2 swapped?") != std::string::npos);
  CHECK(weighed("pairs", drives).find("are theta1 and theta2 swapped?") != std::string::npos);
  for (const char* const name : {"finger", "pairs"}) CHECK(weighed(name, "") == "no error");
}

}  // namespace
