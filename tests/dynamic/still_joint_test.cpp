// Several joints, of which one stands still: it is refused by its name, flickering encoders or not.
#include <fmt/format.h>

#include <random>
#include <sstream>

#include "cablefit/dynamic/rows/joint_settings.hpp"
#include "cablefit/identify/identify.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kCount = 1.2e-5;  // of the encoders, rad

/// The shipped log of the finger with joint 2 at 0, its encoders perhaps between two counts.
std::string log_with_still_joint(const std::string& name, bool flickers) {
  std::istringstream lines(content_of(std::string(CABLEFIT_DATA) + '/' + name));
  std::mt19937 random(3);
  std::string text, line;
  for (bool is_header = true; std::getline(lines, line); is_header = false) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    REQUIRE(cells.size() == 9);  // t, then q, theta, tau and tau_load of both joints
    for (const std::size_t position : {2u, 4u})
      if (!is_header)
        cells[position] = fmt::format("{:.9f}", flickers && random() % 2 == 0 ? kCount : 0.0);
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

struct StillJoint {
  Bench bench;

  StillJoint(const std::string& name, bool flickers) {
    bench.rig = shipped(name + "/blocked.csv").plan.rig;
    bench.rig.search_elongation.clear();
    bench.add_text(log_with_still_joint(name + "/moving.csv", flickers));
  }
};

TEST_CASE("a lower cut-off widens the margin around rest of its own equations only", "[dynamic]") {
  const std::vector<LogSurvey> logs{shipped("two_joints/finger/moving.csv")};
  const DynamicOptions options;
  DynamicJob job{logs,  options, "default", [](const PartSurvey& /*any*/) { return true; }, {}, {},
                 false, {},      {}};
  choose_joint_settings(job, {}, {60, 12});  // cut-offs of 150 and 30 Hz, one period each
  CHECK(job.settings.rows.signal.cutoff == 150);
  CHECK(job.joint_settings[1].rows.signal.cutoff == 30);
  CHECK(job.joint_settings[1].rows.rest_margin == 34);
  CHECK(job.settings.rows.rest_margin == 7);
}

TEST_CASE("a joint that stands still throughout is refused by its name", "[dynamic]") {
  const auto text = [](const char* q, const char* theta) {
    return fmt::format(
        "preload 'default': joint 2 stands still: q2 moves {} rad, theta2 {} rad, within the noise "
        "of the encoders; record a log in which joint 2 moves too",
        q, theta);
  };
  for (const bool flickers : {false, true}) {
    INFO("flickers " << flickers);
    const std::string expected = flickers ? text("1.2e-05", "1.2e-05") : text("0", "0");
    const StillJoint finger("two_joints/finger", flickers);
    const ElasticResult stage1 =
        fit_elastic(std::vector<LogSurvey>{shipped("two_joints/finger/blocked.csv")}, {});
    DynamicOptions options;
    options.models = {"poly"};
    CHECK(message_of([&] { fit_dynamic(finger.bench.logs(), stage1, options); }) == expected);
    const StillJoint pairs("two_joints/pairs", flickers);
    const std::vector<LogSurvey> both{shipped("two_joints/pairs/blocked.csv"),
                                      pairs.bench.logs().front()};
    CHECK(message_of([&] { identify(both, {}); }) == expected);
  }
}

}  // namespace
