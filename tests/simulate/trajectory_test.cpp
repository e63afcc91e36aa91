// --trajectories: the file appears whole or not at all, and reads back as a log.
#include <catch2/catch.hpp>
#include <filesystem>
#include <sstream>

#include "tests/simulate/true_models.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream text(content_of(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

SimulateResult write(const Model& model, const std::string& path) {
  const std::vector<LogSurvey> logs = {shipped_for(model, "high/blocked.csv"),
                                       shipped_for(model, "high/moving_load30.csv")};
  ReplayOptions options;
  options.trajectories = path;
  return simulate_logs(model, logs, options);
}

TEST_CASE("every row, measured and simulated, with tensions and closure", "[simulate]") {
  const TempFolder folder;
  const std::string path = folder.file("deep/rows.csv");
  CHECK(write(true_model("high"), path).trajectories == path);
  const std::vector<std::string> lines = lines_of(path);
  REQUIRE(lines.size() == 1 + 20000 + 16000);
  CHECK(lines[0] ==
        "log,start,t,q,theta,tau,q_sim,theta_sim,tau_sim,tension[1],tension[2],closure");
  CHECK(lines[1].substr(0, 22) == "1,1,0,0,0,-0.359,0,0,-");
  CHECK(lines[501].substr(0, 6) == "1,2,1,");
  CHECK(lines[20001].substr(0, 6) == "2,1,0,");
  std::size_t n_closed = 0, n_slack_1 = 0, n_slack_2 = 0;
  for (const std::string& line : lines) {
    n_closed += line.ends_with(",closure") && line[0] == '2';
    n_slack_1 += line.ends_with(",slack:1") && line[0] == '2';
    n_slack_2 += line.ends_with(",slack:2") && line[0] == '2';
  }
  CHECK(n_closed > 1000);
  CHECK(n_slack_1 > 10000);
  CHECK(n_closed + n_slack_1 + n_slack_2 == 16000);
}

TEST_CASE("the linear model has no cables", "[simulate]") {
  const TempFolder folder;
  const std::string path = folder.file("rows.csv");
  Model model = true_model("high");
  model.transmission.cables.clear();
  model.transmission.linear_stiffness = Eigen::VectorXd::Constant(1, 2500);
  (void)write(model, path);
  CHECK(lines_of(path).at(0) == "log,start,t,q,theta,tau,q_sim,theta_sim,tau_sim");
}

TEST_CASE("nothing is left when the file cannot be written, or a log is refused", "[simulate]") {
  const TempFolder folder;
  folder.write("file", "");
  CHECK(message_of([&] { (void)write(true_model("high"), folder.file("file/rows.csv")); }) ==
        "cannot write " + folder.file("file/rows.csv") + ": Not a directory");

  const Model model = true_model("low");
  const std::vector<LogSurvey> logs = {
      shipped_for(model, "low/blocked.csv"),
      survey_for_simulation(folder.write("log.csv",
                                         "t,q,theta\n0,0,1\n1,0,2\n2,0,3\n3,0,4\n4,0,5\n"
                                         "5,0,6\n6,0,7\n7,0,8\n"),
                            "", model)};
  ReplayOptions options;
  options.trajectories = folder.file("rows.csv");
  CHECK(message_of([&] {
          (void)simulate_logs(model, logs, options);
        }).find("missing column 'tau', needed for replaying the torque") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(folder.file("rows.csv")));
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()),
                      std::filesystem::directory_iterator()) == 2);
}

}  // namespace
