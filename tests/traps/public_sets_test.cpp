// Real logs with rig files that are right: nothing is refused and nothing is odd.
#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "cablefit/samples/weigh/weigh.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;

struct PublicSet {
  const char* folder;
  const char* prefix;  // of the file names that belong to one rig
  const char* rig;     // what is inside the braces besides the schema
};

constexpr const char* kSix =
    R"(, "joints": [{"name":"1"},{"name":"2"},{"name":"3"},{"name":"4"},{"name":"5"},{"name":"6"}])";
constexpr const char* kSeven =
    R"(, "joints": [{"name":"1"},{"name":"2"},{"name":"3"},{"name":"4"},{"name":"5"},{"name":"6"},{"name":"7"}])";
constexpr const char* kLinear = R"(, "motion": "linear")";

const PublicSet kSets[] = {
    {"bam_xl330", "", ""},
    {"brfd_friction_damper", "", R"(, "motion": "linear", "columns": {"w": {"column": "v"}})"},
    {"dvrk_cable_hysteresis", "", kSix},
    {"dvrk_mtm", "mtm_joint4", ""},
    {"dvrk_mtm", "mtm_one", kSeven},
    {"dvrk_mtm", "mtm_two", kSeven},
    {"dvrk_psm", "", kSeven},
    {"dvrk_psm", "",
     R"(, "columns": {"q": {"column": "q4"}, "w": {"column": "dq4"}, "tau": {"column": "tau4"}})"},
    {"emps", "", kLinear},
    {"hsm150", "", R"(, "columns": {"w": {"column": "w_drive"}})"},
    {"lorenz_motor", "", ""},
    {"mis_tool_cable", "tool4L2", ""},
    {"mis_tool_cable", "tool4L4", ""},
    {"mis_tool_cable", "tool5L2", ""},
    {"mis_tool_cable", "tool5L3", ""},
    {"quanser_flexlink", "", ""},
    {"rack_pinion", "", kLinear},
    {"screw_drives", "drive1_st", ""},
    {"screw_drives", "drive2_st", ""},
    {"screw_drives", "drive3_st", ""},
    {"sea_imperial_blocked", "chirp", ""},
    {"sea_imperial_blocked", "spring1", ""},
    {"sea_imperial_blocked", "spring2", ""},
    {"sea_imperial_blocked", "spring3", ""},
    {"sea_imperial_blocked", "spring4", ""},
    {"sea_imperial_blocked", "spring5", ""},
    {"srv02_padova", "blocked", ""},
    {"srv02_padova", "disc", ""},
    {"srv02_padova", "moving", ""},
    {"tx40", "", kSix},
};

std::vector<std::string> csv_files(const std::filesystem::path& folder, const std::string& prefix) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".csv" && name.starts_with(prefix))
      paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// In row 4988 of this log every q is 0.
bool is_true(const std::string& warning) {
  return warning.find("random_wrist_arm.csv:4988: q3 jumps by 0.163") != std::string::npos;
}

std::vector<std::string> warnings_of(const std::vector<std::string>& paths, const Rig& rig) {
  std::vector<LogSurvey> logs;
  for (const std::string& path : paths) logs.push_back(survey_log(plan_log(path, rig), ""));
  weigh_logs(logs);
  std::vector<std::string> warnings;
  for (const LogSurvey& log : logs)
    std::remove_copy_if(log.warnings.begin(), log.warnings.end(), std::back_inserter(warnings),
                        is_true);
  return warnings;
}

TEST_CASE("public sets pass without a word") {
  const std::filesystem::path shared = CABLEFIT_SHARED_DATA;
  if (!std::filesystem::exists(shared)) {
    WARN("skipped: " << shared << " is not there");
    return;
  }
  const test::TempFolder folder;
  for (const PublicSet& set : kSets) {
    CAPTURE(set.folder, set.prefix);
    const std::string rig =
        folder.write("rig.json", std::string(R"({"schema": "cablefit/rig/1")") + set.rig + "}");
    const std::vector<std::string> paths = csv_files(shared / set.folder, set.prefix);
    REQUIRE_FALSE(paths.empty());
    CHECK(warnings_of(paths, read_rig(rig)).empty());
    for (const std::string& path : paths) {
      CAPTURE(path);
      CHECK(warnings_of({path}, read_rig(rig)).empty());
    }
  }
}

TEST_CASE("the shipped logs pass without a word") {
  for (const std::string preload : {"low", "high"}) {
    const std::string folder = std::string(CABLEFIT_DATA) + '/' + preload;
    CAPTURE(folder);
    CHECK(warnings_of(csv_files(folder, ""), read_rig(folder + "/rig.json")).empty());
  }
}

}  // namespace
