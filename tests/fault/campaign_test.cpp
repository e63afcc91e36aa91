// Campaigns that are killed, meet a log that cannot be read or a full disk: what is finished stays,
// what can be done is done. CABLEFIT_CELLS=200 CABLEFIT_CAMPAIGN_KILLS=20 in the environment for
// the full size.
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <thread>

#include "tests/fault/bench.hpp"

namespace {

using namespace cablefit::test;
namespace fs = std::filesystem;

int number_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atoi(text);
}

/// Files as a campaign leaves them, by path, apart from temporaries.
using Files = std::map<std::string, std::string>;

bool is_cell(const std::string& path) {
  return path.starts_with("cells/") && path.ends_with(".json");
}

bool is_temporary(const std::string& path) { return path.find(".cablefit-") != std::string::npos; }

/// A campaign of cells whose logs all differ: they are pieces of the shipped ones, each a row
/// longer than the one before.
class CampaignBench {
 public:
  explicit CampaignBench(int n_cells) : n_cells_(n_cells) {
    const std::string blocked = content_of(CABLEFIT_DATA "/low/blocked.csv");
    const std::string moving = content_of(CABLEFIT_DATA "/low/moving_load30.csv");
    fs::copy_file(CABLEFIT_DATA "/low/rig.json", path("rig.json"));
    nlohmann::json cells = nlohmann::json::array();
    for (int k = 0; k < n_cells; ++k) {
      folder_.write(blocked_log(k), first_lines(blocked, 5000 + k));
      folder_.write(moving_log(k), first_lines(moving, 3000 + k));
      cells.push_back({{"name", name(k)},
                       {"preload", "low"},
                       {"rig", "rig.json"},
                       {"blocked", {blocked_log(k)}},
                       {"moving", {moving_log(k)}}});
    }
    const nlohmann::json campaign = {{"schema", "cablefit/campaign/1"},
                                     {"name", "bench"},
                                     {"cells", cells},
                                     {"estimator", "wls"},
                                     {"models", {"linear", "poly"}},
                                     {"limits", {{"torque_error", 100}}}};
    folder_.write("campaign.json", campaign.dump());
  }

  static std::string name(int k) { return "cell " + std::to_string(k); }
  static std::string blocked_log(int k) { return "blocked" + std::to_string(k) + ".csv"; }
  static std::string moving_log(int k) { return "moving" + std::to_string(k) + ".csv"; }
  std::string path(const std::string& name) const { return folder_.file(name); }
  void write(const std::string& name, const std::string& content) const {
    folder_.write(name, content);
  }
  int n_cells() const { return n_cells_; }

  Ended run(const std::string& out, const Environment& environment = {}, Blow blow = {},
            const std::string& jobs = "2") const {
    return run_program(folder_.path().string(),
                       {"batch", "campaign.json", "--out", out, "--jobs", jobs, "--threads", "2",
                        "--report", out + "/summary.md", "--junit", out + "/gates.xml"},
                       environment, blow);
  }
  Files files(const std::string& out) const { return files_below(path(out)); }

 private:
  TempFolder folder_;
  int n_cells_;
};

/// Which file of a name it is, and when it was written: neither changes but by writing it again.
struct Identity {
  ino_t inode;
  long seconds, nanoseconds;
  bool operator==(const Identity&) const = default;
};

std::map<std::string, Identity> finished_cells(const std::string& out) {
  std::map<std::string, Identity> cells;
  if (!fs::exists(out + "/cells")) return cells;
  for (const auto& entry : fs::directory_iterator(out + "/cells")) {
    const std::string name = entry.path().filename().string();
    if (is_temporary(name)) continue;
    struct stat status {};
    REQUIRE(::stat(entry.path().c_str(), &status) == 0);
    cells[name] = {status.st_ino, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
  }
  return cells;
}

/// The temporaries that kills left, made old enough for the next run to remove them.
std::size_t age_temporaries(const std::string& out) {
  std::size_t n = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    if (!is_temporary(entry.path().filename().string())) continue;
    fs::last_write_time(entry.path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
    ++n;
  }
  return n;
}

double seconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST_CASE("a campaign that is killed and goes on ends as an undisturbed one, no cell done twice") {
  const CampaignBench bench(number_from("CABLEFIT_CELLS", 30));
  const int n_kills = number_from("CABLEFIT_CAMPAIGN_KILLS", 5);
  const double usual = seconds_of([&] { REQUIRE(bench.run("whole").exit_code == 0); });
  const Files whole = bench.files("whole");
  // The moments add up to about the time of the work: each kill comes in the middle of it.
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> moment(0, 2 * usual / n_kills);
  std::map<std::string, Identity> finished;
  int n_killed = 0, n_in_the_middle = 0;
  for (int k = 0; k < n_kills; ++k) {
    INFO("kill " << k);
    const Ended ended = bench.run("cut", {}, {SIGKILL, static_cast<long>(1e6 * moment(engine))});
    REQUIRE((ended.signal == SIGKILL || ended.exit_code == 0));
    n_killed += ended.signal == SIGKILL;
    const auto now = finished_cells(bench.path("cut"));
    for (const auto& [name, identity] : finished) CHECK((now.at(name) == identity));
    for (const auto& [name, content] : bench.files("cut"))
      if (is_cell(name)) CHECK((content == whole.at(name)));
    n_in_the_middle += now.size() > finished.size() && now.size() < whole.size() - 5;
    finished = now;
  }
  const std::size_t n_left = fs::exists(bench.path("cut")) ? age_temporaries(bench.path("cut")) : 0;
  REQUIRE(bench.run("cut").exit_code == 0);
  const auto now = finished_cells(bench.path("cut"));
  CHECK(now.size() == static_cast<std::size_t>(bench.n_cells()));
  for (const auto& [name, identity] : finished) CHECK((now.at(name) == identity));
  CHECK((bench.files("cut") == whole));
  CHECK(n_in_the_middle > 0);
  std::printf(
      "    %d cells in %.1f s; %d of %d runs killed, %d with some cells done and some not, "
      "%zu temporaries left and removed; %zu cells done before the last run\n",
      bench.n_cells(), usual, n_killed, n_kills, n_in_the_middle, n_left, finished.size());
}

TEST_CASE("logs that cannot be read cost their cells, and nothing else") {
  const CampaignBench bench(5);
  REQUIRE(bench.run("whole").exit_code == 0);
  bench.write(CampaignBench::moving_log(1), "t,q,theta,tau,tau_load\n0,0,0,zero,30\n");
  fs::remove(bench.path(CampaignBench::blocked_log(3)));
  fs::create_directory_symlink("nowhere", bench.path(CampaignBench::blocked_log(3)));
  const Ended ended = bench.run("out");
  CHECK(ended.exit_code == 3);
  std::string last;
  std::istringstream lines(ended.err);
  std::vector<std::string> failed;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("FAILED: ")) failed.push_back(line);
  REQUIRE(failed.size() == 2);
  CHECK(failed[0].starts_with("FAILED: cell 1: moving1.csv:2:7: "));
  CHECK(failed[1].starts_with("FAILED: cell 3: "));
  CHECK(failed[1].find("blocked3.csv") != std::string::npos);
  const auto json = nlohmann::json::parse(content_of(bench.path("out/batch.json")));
  CHECK(json["failed"].size() == 2);
  const auto whole = nlohmann::json::parse(content_of(bench.path("whole/batch.json")));
  for (const int k : {0, 2, 4}) CHECK(json["cells"][k] == whole["cells"][k]);
}

/// Each run has one call that writes fail, until one has none; then a run without finds what is
/// left to do, and ends as one that nothing happened to.
TEST_CASE("a full disk costs what could not be written, and the next run does it") {
  const CampaignBench bench(3);
  REQUIRE(bench.run("whole", {}, {}, "1").exit_code == 0);
  const Files whole = bench.files("whole");
  const Environment counted = {{"FAULT_COUNT", bench.path("count")}};
  REQUIRE(bench.run("counted", counted, {}, "1").exit_code == 0);
  int n_calls = 0, n_cells_lost = 0;
  std::istringstream(content_of(bench.path("count"))) >> n_calls;
  REQUIRE(n_calls > 10);
  for (int k = 1; k <= n_calls; ++k) {
    fs::remove_all(bench.path("out"));
    const Ended ended = bench.run("out", {{"FAULT_WRITE", std::to_string(k) + ":ENOSPC"}}, {}, "1");
    INFO("call " << k << ": exit " << ended.exit_code << "\n" << ended.err);
    REQUIRE(ended.exit_code == 5);
    REQUIRE(ended.err.find("cannot write out/") != std::string::npos);
    const Files files = bench.files("out");
    for (const auto& [name, content] : files) {
      INFO(name);
      REQUIRE(!is_temporary(name));
      if (is_cell(name)) REQUIRE((content == whole.at(name)));
    }
    const auto n_done = std::count_if(files.begin(), files.end(),
                                      [](const auto& file) { return is_cell(file.first); });
    REQUIRE(n_done >= 2);
    if (n_done == 2) {
      ++n_cells_lost;
      const auto json = nlohmann::json::parse(files.at("batch.json"));
      REQUIRE(json["failed"].size() == 1);
      REQUIRE(json["failed"][0]["code"] == 5);
    }
    REQUIRE(bench.run("out", {}, {}, "1").exit_code == 0);
    REQUIRE((bench.files("out") == whole));
  }
  CHECK(n_cells_lost >= 3);
  std::printf("    %d runs, one call failing in each; %d of them lost one of 3 cells\n", n_calls,
              n_cells_lost);
}

// Not in ctest: what it measures depends on what else the machine does.
TEST_CASE("throughput of two jobs beside that of one, and of two processes", "[.throughput]") {
  const CampaignBench bench(number_from("CABLEFIT_CELLS", 60));
  const auto run = [&](const std::string& out, const std::string& jobs) {
    fs::remove_all(bench.path(out));
    return seconds_of([&] { REQUIRE(bench.run(out, {}, {}, jobs).exit_code == 0); });
  };
  run("warm", "2");
  for (int k = 0; k < 5; ++k) {
    const double one = run("one", "1"), two = run("two", "2");
    // The ceiling: two processes that know nothing of each other, each with all cells.
    const double both = seconds_of([&] {
      std::thread other([&] { run("a", "1"); });
      run("b", "1");
      other.join();
    });
    std::printf("    1 job %.2f s, 2 jobs %.2f s: %.2f times; two processes %.2f times\n", one, two,
                one / two, 2 * one / both);
  }
}

}  // namespace
