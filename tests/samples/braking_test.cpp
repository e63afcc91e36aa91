// A drive that takes work: its torque is reversed, or other joints move it.
#include <cmath>

#include "cablefit/samples/weigh/weigh.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// 20 s of two joints without cables between them: each drive works against its own friction, and
/// the torque of the first takes work from a motion of this amplitude, rad.
std::string log_text(double way) {
  std::string text = "t,theta1,theta2,tau1,tau2\n";
  for (int i = 0; i <= 4000; ++i) {
    const double t = 0.005 * i, x = std::sin(M_PI * t), v = std::cos(M_PI * t);
    text += fmt::format("{},{},{},{},{}\n", t, way * x, 0.5 * x, -2 * way * v, 3 * v);
  }
  return text;
}

struct Told {
  std::string error = "no error";
  std::vector<std::string> warnings;
};

Told told(double way) {
  const TempFolder folder;
  const std::string rig = folder.write(
      "rig.json", R"({"schema": "cablefit/rig/1", "joints": [{"name": "a"}, {"name": "b"}]})");
  std::vector<LogSurvey> logs{survey_file(folder.write("a.csv", log_text(way)), read_rig(rig))};
  Told told;
  told.error = message_of([&] { weigh_logs(logs); }, folder.path());
  told.warnings = logs.front().warnings;
  return told;
}

TEST_CASE("a joint that others move may brake", "[samples]") {
  const Told large = told(0.5), small = told(0.02);
  CHECK(large.error ==
        "a.csv: tau1 brakes: over a closed motion it does -15.7 J of work, of 15.7 J exchanged; "
        "the sign of tau1 is reversed against the positions; write \"tau1\": {\"column\": "
        "\"tau1\", \"scale\": -1} in the rig file's columns");
  CHECK(small.error == "no error");
  REQUIRE(small.warnings.size() == 1);
  CHECK(small.warnings.front().find(
            "other joints move this one, or the sign of tau1 is reversed") != std::string::npos);
}

}  // namespace
