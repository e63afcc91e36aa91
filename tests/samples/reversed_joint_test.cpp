// Signs and references of shipped logs that their rig files have wrong.
#include <cmath>

#include "cablefit/samples/weigh/weigh.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

struct Told {
  std::string error;
  std::vector<std::string> warnings;
};

/// `more`: keys of the set's rig file.
Told told(const std::string& set, const std::string& log, const std::string& more) {
  const std::string from = std::string(CABLEFIT_DATA) + "/two_joints/" + set;
  const TempFolder folder;
  std::string rig = content_of(from + "/rig.json");
  rig.insert(1, more);
  folder.write("rig.json", rig);
  for (const std::string& file : {log, std::string("finger.urdf")})
    folder.write(file, content_of(from + '/' + file));
  const std::string path = folder.file(log);
  Told told;
  told.error = message_of(
      [&] {
        std::vector<LogSurvey> logs{survey_file(path, rig_for_log(path, ""))};
        weigh_logs(logs);
        told.warnings = logs.front().warnings;
      },
      folder.path());
  return told;
}

std::string reversed(const std::string& channel) {
  return fmt::format(R"("columns": {{"{0}": {{"column": "{0}", "scale": -1}}}}, )", channel);
}

TEST_CASE("a reversed torque of one of several moving joints is refused", "[samples]") {
  for (const char* const set : {"finger", "pairs", "phalanges"}) {
    CAPTURE(set);
    CHECK(told(set, "moving.csv", "").error == "no error");
    for (const char* const joint : {"1", "2"}) {
      const std::string tau = std::string("tau") + joint, theta = std::string("theta") + joint;
      const std::string error = told(set, "moving.csv", reversed(tau)).error;
      CAPTURE(error);
      const std::string q = std::string("q") + joint;
      CHECK(error.starts_with("moving.csv: " + tau + " is reversed against " + q + " and " + theta +
                              ": it falls as " + theta + " grows while the links stay (slope -"));
      CHECK(error.ends_with("; write \"" + tau + "\": {\"column\": \"" + tau +
                            "\", \"scale\": 1} in the rig file's columns"));
    }
  }
}

TEST_CASE("a reversed link that moves like a sine is refused by the torques", "[samples]") {
  const auto refusal = [](const char* set, const char* q) {
    return told(set, "moving.csv", reversed(q)).error;
  };
  for (const auto& [set, q] : {std::pair{"finger", "q1"}, {"pairs", "q2"}, {"phalanges", "q1"}})
    CHECK(refusal(set, q).find(std::string(q) + " is reversed: the motors are ") !=
          std::string::npos);
}

TEST_CASE("a joint that is reversed against its cables is refused", "[samples]") {
  const auto refusal = [](const std::string& set, const std::vector<std::string>& channels) {
    std::string columns;
    for (const std::string& channel : channels)
      columns += fmt::format(R"({}"{}": {{"column": "{}", "scale": -1}})",
                             columns.empty() ? "" : ", ", channel, channel);
    return told(set, "moving.csv", "\"columns\": {" + columns + "}, ").error;
  };
  // A cable over both joints shows the whole joint; the other one turned would be the same.
  for (const std::string set : {"finger", "pairs", "phalanges"})
    for (const std::string joint : {"1", "2"}) {
      const std::string error = refusal(set, {"q" + joint, "theta" + joint, "tau" + joint});
      CAPTURE(set, joint, error);
      CHECK(error.starts_with("moving.csv: q1, theta1 and tau1 are reversed against the cables: "));
      CHECK(
          error.ends_with("and the same of theta1 and tau1, or all of a joint that shares its "
                          "cables"));
    }
  // All of them turned is another way to count the angles.
  CHECK(refusal("finger", {"q1", "q2", "theta1", "theta2", "tau1", "tau2"}) == "no error");
  // A motor wired backwards, on a motion like a sine.
  CHECK(refusal("pairs", {"q2", "tau2"}).find("q2 is reversed: the motors are ") !=
        std::string::npos);
}

/// A log of 20 s at 200 Hz: joint 1 holds by a PD controller with this delay in steps, joint 2 that
/// its cables pass pushes its link.
std::string held_motor(int delay) {
  constexpr double kStiffness = 100, kP = 30, kD = 0.1, kStep = 0.005;
  std::string text = "t,q1,q2,theta1,theta2,tau1,tau2\n";
  std::vector<double> theta(static_cast<std::size_t>(delay) + 2, 0.0);
  for (int i = 0; i < 4000; ++i) {
    const double t = kStep * i;
    const double q = 0.3 * std::sin(2 * t) + 0.1 * std::sin(5.3 * t) + 0.05 * std::sin(11 * t);
    // Massless: the controller's late torque holds the pull of the cables.
    const double late = theta[theta.size() - 1 - static_cast<std::size_t>(delay)];
    const double before = theta[theta.size() - 2 - static_cast<std::size_t>(delay)];
    const double tau = -kP * late - kD * (late - before) / kStep;
    theta.push_back(q + tau / kStiffness);
    text += fmt::format("{},{},{},{},{},{},{}\n", t, q, 0.5 * q, theta.back(), 0.5 * q, tau,
                        3 * std::cos(2 * t));
  }
  return text;
}

TEST_CASE("a motor that holds against others is not taken for reversed", "[samples]") {
  const TempFolder folder;
  const std::string rig = folder.write(
      "rig.json", R"({"schema": "cablefit/rig/1", "joints": [{"name": "a"}, {"name": "b"}]})");
  for (const int delay : {0, 1, 2}) {
    std::vector<LogSurvey> logs{
        survey_file(folder.write("a.csv", held_motor(delay)), read_rig(rig))};
    const std::string error = message_of([&] { weigh_logs(logs); }, folder.path());
    CAPTURE(delay, error);
    CHECK(error.find("while the links stay") == std::string::npos);
  }
}

TEST_CASE("joints at rest are weighed", "[samples]") {
  const TempFolder folder;
  const std::string rig = folder.write(
      "rig.json", R"({"schema": "cablefit/rig/1", "joints": [{"name": "a"}, {"name": "b"}]})");
  std::string text = "t,q1,q2,theta1,theta2,tau1,tau2,phase\n";
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("{},0.1,0.2,0.1,0.2,{},0,moving\n", 0.005 * i, i % 7);
  std::vector<LogSurvey> logs{survey_file(folder.write("a.csv", text), read_rig(rig))};
  CHECK(message_of([&] { weigh_logs(logs); }, folder.path()) == "no error");
}

TEST_CASE("a reversed link of several moving joints is refused", "[samples]") {
  for (const char* const set : {"finger", "pairs", "phalanges"})
    for (const char* const q : {"q1", "q2"}) {
      const std::string error = told(set, "moving.csv", reversed(q)).error;
      CAPTURE(set, q, error);
      CHECK(error.starts_with("moving.csv: " + std::string(q) + " is reversed: the "));
      CHECK(error.find("write \"" + std::string(q) + "\": {") != std::string::npos);
    }
}

TEST_CASE("a reversed torque or drive of a joint with blocked links is refused", "[samples]") {
  for (const char* const set : {"finger", "pairs", "phalanges"}) {
    CAPTURE(set);
    CHECK(told(set, "blocked.csv", "").error == "no error");
    for (const char* const channel : {"tau1", "tau2", "theta1", "theta2"}) {
      const std::string joint(1, std::string(channel).back());
      const std::string error = told(set, "blocked.csv", reversed(channel)).error;
      CAPTURE(channel, error);
      CHECK(error.find("tau" + joint + " falls as theta" + joint +
                       " grows while the links are blocked") != std::string::npos);
    }
  }
}

TEST_CASE("a controller's reference that the log lacks is reported", "[samples]") {
  const std::string from = std::string(CABLEFIT_DATA) + "/low/";
  const TempFolder folder;
  std::string rig = content_of(from + "rig.json");
  const std::string usual = R"("reference": "theta_ref")";
  REQUIRE(rig.find(usual) != std::string::npos);
  rig.replace(rig.find(usual), usual.size(), R"("reference": "command")");
  folder.write("rig.json", rig);
  const std::string path = folder.write("moving.csv", content_of(from + "moving_load30.csv"));
  std::vector<LogSurvey> logs{survey_file(path, rig_for_log(path, ""))};
  weigh_logs(logs);
  REQUIRE(logs.front().warnings.size() == 1);
  CHECK(logs.front().warnings.front().find(
            "the controller's reference 'command' is not a column of the log, and theta_ref is not "
            "used; write the column's name as \"reference\", or \"theta_ref\"") !=
        std::string::npos);
}

}  // namespace
