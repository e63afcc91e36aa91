// Logs of one bench under loads that their rig files say.
#include "cablefit/samples/load_channels.hpp"

#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/survey/windows.hpp"
#include "tests/samples/rows_of_logs.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::string rig_text(const std::string& load, const std::string& more = "") {
  return fmt::format(R"({{"schema": "cablefit/rig/1"{}{}}})",
                     load.empty() ? "" : ", \"load\": " + load, more);
}

/// One log per rig file, all of the same motion.
std::vector<LogSurvey> logs_of(const TempFolder& folder, const std::vector<std::string>& rigs) {
  std::string text = "t,q,theta,tau\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{},{},{},{}\n", 0.01 * i, std::sin(0.02 * i), std::sin(0.02 * i) + 0.001,
                        std::cos(0.02 * i));
  std::vector<LogSurvey> logs;
  for (std::size_t k = 0; k < rigs.size(); ++k)
    logs.push_back(survey_file(folder.write(fmt::format("log{}.csv", k), text),
                               read_rig(folder.write(fmt::format("rig{}.json", k), rigs[k]))));
  return logs;
}

std::string disagreement(const std::vector<LogSurvey>& logs) {
  return message_of([&] {
    require_agreement(
        logs, [](const PartSurvey&) { return true; }, "default");
  });
}

constexpr const char* kRope = R"({"type": "constant", "torque": -12})";
constexpr const char* kArm = R"({"type": "pendulum", "mass": 2, "length": 0.5})";

TEST_CASE("load laws that differ become a channel of each log", "[samples]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs = logs_of(folder, {rig_text(kRope), rig_text(kArm)});
  CHECK_THAT(disagreement(logs), Catch::Matchers::Contains("has logs of two rigs"));
  make_load_channels(logs);
  CHECK(disagreement(logs) == "no error");
  const auto load = [&](std::size_t k) {
    const int slot = logs[k].plan.find(Channel::tau_load);
    REQUIRE(slot >= 0);
    return logs[k].parts.at(0).channels.at(static_cast<std::size_t>(slot));
  };
  CHECK(load(0).min == -12);
  CHECK(load(0).max == -12);
  CHECK_THAT(load(1).max, Catch::WithinRel(2 * kGravity * 0.5 * std::sin(1.), 1e-3));
  CHECK(load(1).noise == 0);  // no sensor's
  const int q = logs[1].plan.find(Channel::q), slot = logs[1].plan.find(Channel::tau_load);
  std::size_t n_rows = 0;
  for_each_window(
      logs[1], [](const PartSurvey&) { return true; }, 0, 1, 0,
      [&](Window&& window) {
        for (Eigen::Index i = 0; i < window.data.rows(); ++i, ++n_rows)
          CHECK_THAT(window.data(i, slot),
                     Catch::WithinAbs(-2 * kGravity * 0.5 * std::sin(window.data(i, q)), 1e-12));
        return true;
      });
  CHECK(n_rows == 400);
}

TEST_CASE("a load with an inertia of its own is named", "[samples]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs = logs_of(folder, {rig_text(kRope), rig_text(kArm)});
  make_load_channels(logs);
  CHECK(logs[0].warnings.empty());
  REQUIRE(logs[1].warnings.size() == 1);
  CHECK(logs[1].warnings[0] ==
        logs[1].plan.path +
            ": J_link includes the inertia of its load (0.5 kg m^2), because the rig files of the "
            "logs differ in their load; fit one load at a time for the J_link of the link alone");
}

TEST_CASE("rig files that differ in more than the load are two rigs", "[samples]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs =
      logs_of(folder, {rig_text(kRope), rig_text(kArm, R"(, "torque_hold": "none")")});
  make_load_channels(logs);
  CHECK_FALSE(logs[0].plan.has(Channel::tau_load));
  CHECK_THAT(disagreement(logs), Catch::Matchers::Contains("which differ in \"torque_hold\""));
}

TEST_CASE("the name of a rig file is only a label", "[samples]") {
  const TempFolder folder;
  const std::vector<LogSurvey> logs =
      logs_of(folder, {rig_text(kRope), rig_text(kRope, R"(, "name": "bench at the window")")});
  CHECK(disagreement(logs) == "no error");
}

TEST_CASE("a moving log without a load beside one with is refused", "[samples]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs = logs_of(folder, {rig_text(""), rig_text(kRope)});
  make_load_channels(logs);
  CHECK_THAT(disagreement(logs), Catch::Matchers::Contains("has logs of two rigs"));
}

TEST_CASE("a blocked log needs no load, in any order", "[samples]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs = logs_of(folder, {rig_text(""), rig_text(kRope)});
  logs[0].parts[0].phase = Phase::blocked;
  make_load_channels(logs);
  CHECK(disagreement(logs) == "no error");
  std::swap(logs[0], logs[1]);
  CHECK(disagreement(logs) == "no error");
}

TEST_CASE("logs of one load keep its law, however their rig files are written", "[samples]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs =
      logs_of(folder, {rig_text(kArm), rig_text(kArm) + "\n// a copy\n", rig_text(kArm)});
  make_load_channels(logs);
  CHECK(disagreement(logs) == "no error");
  for (const LogSurvey& log : logs) {
    CHECK_FALSE(log.plan.has(Channel::tau_load));
    CHECK(log.plan.rig.load.law->name == "pendulum");
  }
}

}  // namespace
