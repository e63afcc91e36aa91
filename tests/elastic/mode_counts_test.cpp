// The share of the rows in force closure, and that of each slack cable.
#include <algorithm>
#include <fstream>

#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {
namespace {

const std::string kHigh = std::string(CABLEFIT_DATA) + "/high/";

/// Share of the samples of the shipped high log with both cables taut, by its l_o (data/README.md)
/// and the logged positions alone. Of samples in motion: 2.4e-5 is the encoder's count, and the
/// rest speed 0.00168 rad/s are 7 counts in 50 samples of 2 ms.
double closure_in_log() {
  std::ifstream file(kHigh + "blocked.csv");
  std::string line;
  std::getline(file, line);
  std::vector<double> phi;
  while (std::getline(file, line)) {
    double t = 0, q = 0, theta = 0;
    REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &q, &theta) == 3);
    phi.push_back(theta - q);
  }
  double all = 0, closure = 0;
  for (std::size_t i = 25; i + 25 < phi.size(); ++i) {
    if (std::abs(phi[i + 25] - phi[i - 25]) < 7 * 2.4e-5) continue;
    ++all;
    if (phi[i] > -0.00512 && phi[i] < 0.004668802) ++closure;
  }
  return closure / all;
}

TEST_CASE("rows of a preloaded log are counted by mode", "[elastic]") {
  const std::vector<LogSurvey> logs = {
      survey_file(kHigh + "blocked.csv", read_rig(kHigh + "rig_cables.json"), "high")};
  const ElasticPreload high = fit_elastic(logs, {}).preloads.at(0);
  const auto rows = static_cast<double>(high.counts.rows_used);
  const ModeCounts& modes = high.modes;
  REQUIRE(modes.slack.size() == 2);
  CHECK(modes.slack[0].cable == "agonist");
  CHECK(modes.slack[1].cable == "antagonist");
  // They never go slack together.
  CHECK(modes.closure + modes.slack[0].rows + modes.slack[1].rows == high.counts.rows_used);
  // 64 rows in 14 crossings of 4.6 rows, each off by half a row at most: 11 %.
  CHECK(static_cast<double>(modes.closure) / rows == Approx(closure_in_log()).epsilon(0.11));
}

TEST_CASE("rows of several joints are counted by mode", "[elastic]") {
  PlainRig rig;
  rig.joints = {PlainJoint{}, PlainJoint{}};
  rig.joints[1].sweep_rate = 0.037;
  const PlainMap none = round_map(0), up = round_map(0.03), down = round_map(-0.03);
  rig.cables = {{"1", {up, none}, {up, none}, {3e5, 1e7}},
                {"2", {down, none}, {down, none}, {2.5e5, 2e7}},
                {"3", {none, up}, {none, up}, {4e5, 1e7}},
                {"4", {none, down}, {none, down}, {5e5, 2e7}}};
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  bench.add_text(blocked_log(rig, {0.1, 0.1}, 60, 92));
  const ElasticPreload preload = fit_elastic(bench.logs(), {}).preloads.at(0);
  const ModeCounts& modes = preload.modes;
  REQUIRE(modes.slack.size() == 4);
  // Without preload one cable of each pair is slack, and the rows of both joints count.
  CHECK(modes.closure == 0);
  CHECK(modes.slack[0].rows + modes.slack[1].rows == preload.counts.rows_used);
  CHECK(modes.slack[2].rows + modes.slack[3].rows == preload.counts.rows_used);
  CHECK(modes.slack[2].rows > preload.counts.rows_used / 4);
}

}  // namespace
}  // namespace cablefit::test
