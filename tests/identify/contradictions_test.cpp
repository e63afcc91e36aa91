// Logs and rigs that contradict each other are reported or refused, instead of fitted with a small
// sd.
#include "cablefit/samples/weigh/weigh.hpp"
#include "tests/identify/simulated_rigs.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plain_rigs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::vector<std::string> all_warnings(const IdentifyResult& r) {
  std::vector<std::string> all = r.warnings;
  for (const IdentifyPreload& p : r.preloads)
    all.insert(all.end(), p.warnings.begin(), p.warnings.end());
  return all;
}

TEST_CASE("a preload taken for none does not pass", "[identify]") {
  const std::vector<LogSurvey> logs = {shipped("high/blocked.csv"),
                                       shipped("high/moving_load30.csv"),
                                       shipped("high/moving_load-40.csv")};
  IdentifyOptions known;
  known.elongations = ElongationMode::known;
  const std::vector<std::string> warnings = all_warnings(identify(logs, known));
  CHECK(warns(warnings, "the residual of the blocked equation is "));  // 9 of 145 N m
  CHECK(warns(warnings, "of its largest torque: the sd do not include this error of the model"));
  CHECK(warns(warnings, "try --l-o search"));
  CHECK(warns(warnings, "blocked and moving logs do not agree on them"));
  const std::vector<LogSurvey> right = {shipped("low/blocked.csv"),
                                        shipped("low/moving_load30.csv")};
  for (const std::string& warning : all_warnings(identify(right, {}))) {
    INFO(warning);
    CHECK(warning.find("leaves") == std::string::npos);
    CHECK(warning.find("do not agree") == std::string::npos);
  }
}

TEST_CASE("an encoder zero that is off does not pass", "[identify]") {
  truth::Log log = blocked_log(truth::Rig::low(), 55);
  truth::Log moving = moving_log(truth::Rig::low(), 56, 20);
  for (truth::Log* l : {&log, &moving})
    for (double& theta : l->theta) theta += 5e-3;
  PreloadedBench bench;
  bench.add("low", log);
  bench.add("low", moving);
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  const std::vector<std::string> warnings = all_warnings(identify(bench.logs(), options));
  CHECK(warns(warnings, "encoder zeros of q and theta"));
}

// Blocked logs of cables that go to the other side of the link's pulley: as if each pulled the
// wrong way.
TEST_CASE("a rig of other signs is refused", "[identify]") {
  PreloadedBench bench;
  bench.rig.cables_given = true;
  for (Cable& cable : bench.rig.transmission.cables) {
    cable.motor_map = round_pulleys(-cable.motor_radii(Eigen::VectorXd::Zero(1)));
    cable.initial_elongation = -0.1;  // and never taut
  }
  bench.add("low", blocked_log(truth::Rig::low(), 65));
  const std::string message = message_of([&] { identify(bench.logs(), {}); });
  INFO(message);
  CHECK(message.starts_with("preload 'low': these cables do not explain the blocked logs"));
  CHECK(message.find("check the signs of the radii") != std::string::npos);
}

TEST_CASE("pulleys on which no tensions balance are refused", "[identify]") {
  Bench bench;
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.cables = {{"a", {round_map(0.03)}, {round_map(0.05)}, {2e5, 1e7}, 1e-3},
                {"b", {round_map(-0.03)}, {round_map(-0.04)}, {2e5, 1e7}, 1e-3}};
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  bench.add_text(blocked_log(rig, {0}, 30, 75));
  CHECK(message_of([&] { identify(bench.logs(), {}); }, bench.folder().path().string()) ==
        "rig.json: preload 'default': no cable forces balance these initial "
        "elongations in the reference pose: motor and link would move; give every "
        "cable its elongation, or \"search\"; check the signs of the radii, and that "
        "motor_radius / link_radius is the same for cables that pull against each other");
}

TEST_CASE("logs of one preload with different rigs are refused in any order", "[identify]") {
  const TempFolder folder;
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.cables = {{"a", {round_map(0.03)}, {round_map(0.03)}, {2e5, 1e7}, 0},
                {"b", {round_map(-0.03)}, {round_map(-0.03)}, {2e5, 1e7}, 0}};
  const std::string blocked = folder.write("blocked.csv", blocked_log(rig, {0}, 20, 85));
  const std::string moving = folder.write("moving.csv", moving_log(rig, 5, 86));
  const Rig one = read_rig(folder.write("one.json", rig_text(rig, "")));
  rig.cables[0].k = {2e5};
  const Rig other = read_rig(folder.write("other.json", rig_text(rig, "")));
  for (const bool turned : {false, true}) {
    std::vector<LogSurvey> logs = {survey_file(blocked, one), survey_file(moving, other)};
    if (turned) std::swap(logs[0], logs[1]);
    CHECK(message_of([&] { identify(logs, {}); }).find("has logs of two rigs") !=
          std::string::npos);
  }
}

TEST_CASE("cables of other pulleys are no shared cables", "[identify]") {
  const TempFolder folder;
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  // The same radii at -0.1, 0 and 0.2 rad: 1 + x (x + 0.1) (x - 0.2) 4.
  rig.cables = {{"a", {round_map(0.03)}, {round_map(0.03)}, {2e5}, 0},
                {"b", {round_map(-0.03)}, {round_map(-0.03)}, {2e5}, 0}};
  std::vector<LogSurvey> logs;
  for (const char* preload : {"one", "other"}) {
    const Rig read =
        read_rig(folder.write(fmt::format("{}.json", preload),
                              rig_text(rig, fmt::format(R"( "preload": "{}",)", preload))));
    logs.push_back(
        survey_file(folder.write(fmt::format("{}.csv", preload), blocked_log(rig, {0}, 20, 95)),
                    read, preload));
    rig.cables[0].motor = {{{0.03, -0.03 * 0.02 * 4, -0.03 * 0.1 * 4, 0.03 * 4}}};
  }
  CHECK(message_of([&] { identify(logs, {}); }).find("have rigs with different cables") !=
        std::string::npos);
}

TEST_CASE("the same log twice is told", "[identify]") {
  PreloadedBench bench;
  const truth::Log log = blocked_log(truth::Rig::low(), 96);
  bench.add("low", log);
  bench.add("low", log);
  std::vector<LogSurvey> logs = bench.logs();
  weigh_logs(logs);
  CHECK(warns(identify(logs, {}).warnings, "holds the same samples as"));
}

// 30 kg and 20 kg at 10 cm: 0.3 and 0.2 kg m^2 beside the link's own 0.05.
TEST_CASE("the link is one under two loads", "[identify][recover]") {
  const TempFolder folder;
  std::vector<LogSurvey> logs;
  unsigned seed = 101;
  for (const auto& [preload, mass] : {std::pair{"A", 3.0}, std::pair{"B", 2.0}}) {
    PlainRig rig;
    rig.joints = {PlainJoint{}};
    rig.joints[0].load = 0;
    rig.joints[0].sweep = 0.05;
    rig.cables = {{"a", {round_map(0.03)}, {round_map(0.03)}, {2e5, 1e7}, 5e-4},
                  {"b", {round_map(-0.03)}, {round_map(-0.03)}, {2e5, 1e7}, 5e-4}};
    const std::string load = fmt::format(
        R"( "preload": "{}", "load": {{"type": "hanging_mass", "mass": {}, "radius": 0.1}},)",
        preload, mass);
    const Rig read = read_rig(folder.write(fmt::format("{}.json", preload), rig_text(rig, load)));
    logs.push_back(survey_file(
        folder.write(fmt::format("b{}.csv", preload), blocked_log(rig, {0}, 40, seed++)), read,
        preload));
    rig.joints[0].J_link += mass * 0.01;
    const double weight = mass * kGravity * 0.1;
    rig.link_dynamics = [weight, J = rig.joints[0].J_link](const std::vector<double>&,
                                                           const std::vector<double>&,
                                                           const std::vector<double>& torque) {
      return std::vector<double>{(torque[0] + weight) / J};
    };
    logs.push_back(survey_file(
        folder.write(fmt::format("m{}.csv", preload), moving_log(rig, 20, seed++)), read, preload));
  }
  const IdentifyResult r = identify(logs, {});
  CHECK(!warns(r.warnings, "inertias differ"));
  check_recovered(r.preloads.at(0).parameters, {{"J_link", 0.05 + 0.03}}, 3);
  check_recovered(r.preloads.at(1).parameters, {{"J_link", 0.05 + 0.02}}, 3);
  CHECK(find_estimate(r.parameters, "J_link") == nullptr);
  for (const IdentifyPreload& p : r.preloads) CHECK(p.model.has_value());
}

}  // namespace
