// A drive that takes work: its torque is reversed, or other joints move it.
#include <cmath>

#include "cablefit/samples/weigh/weigh.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// 20 s of two joints: the second drive works against friction, the torque of the first takes work
/// from a motion of this amplitude, rad.
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

constexpr const char* kAlone =
    R"({"schema": "cablefit/rig/1", "joints": [{"name": "a"}, {"name": "b"}]})";
// A cable of the first motor passes both links.
constexpr const char* kCoupled =
    R"({"schema": "cablefit/rig/1", "joints": [{"name": "a"}, {"name": "b"}],
  "cables": [{"name": "1", "motor_radius": [0.01, 0], "link_radius": [0.01, 0.01]},
             {"name": "2", "motor_radius": [-0.01, 0], "link_radius": [-0.01, 0]},
             {"name": "3", "motor_radius": [0, 0.01], "link_radius": [0, 0.01]},
             {"name": "4", "motor_radius": [0, -0.01], "link_radius": [0, -0.01]}]})";

Told told(const char* rig_text, double way) {
  const TempFolder folder;
  const std::string rig = folder.write("rig.json", rig_text);
  std::vector<LogSurvey> logs{survey_file(folder.write("a.csv", log_text(way)), read_rig(rig))};
  Told told;
  told.error = message_of([&] { weigh_logs(logs); }, folder.path());
  told.warnings = logs.front().warnings;
  return told;
}

TEST_CASE("a joint that others move may brake", "[samples]") {
  const std::string reversed = "the sign of tau1 is reversed against the positions";
  // Nothing hands work to a joint without a cable or masses in common with others.
  const Told alone = told(kAlone, 0.5);
  CHECK(alone.error ==
        "a.csv: tau1 brakes: over a closed motion it does -15.7 J of work, of 15.7 J exchanged; " +
            reversed +
            "; write \"tau1\": {\"column\": \"tau1\", \"scale\": -1} in the rig file's columns");
  CHECK(told(kAlone, 0.02).error.find(reversed) != std::string::npos);
  // The other drive may give this work, but not more than it does itself, 47 J.
  const Told moved = told(kCoupled, 0.5);
  CHECK(moved.error == "no error");
  REQUIRE(moved.warnings.size() == 1);
  CHECK(moved.warnings.front().find("other joints move this one, or " + reversed) !=
        std::string::npos);
  CHECK(told(kCoupled, 2).error.find(reversed) != std::string::npos);
}

}  // namespace
