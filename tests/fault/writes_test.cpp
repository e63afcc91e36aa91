// Every call that writes fails in turn: exit code 5 naming the path, or no harm at all; each target
// is the old file or the new one, and nothing else is there.
#include <catch2/catch.hpp>
#include <csignal>
#include <cstdio>

#include "tests/fault/bench.hpp"

namespace {

using namespace cablefit::test;

bool is_given(const Ended& ended, const Writer& writer) {
  for (const std::string& target : writer.targets) {
    if (ended.err.find("cannot write out/" + target + ": ") != std::string::npos) return true;
  }
  return false;
}

/// Fails call after call until a run is through without meeting the one that should fail.
int fail_each(const FaultBench& bench, const Writer& writer, const std::string& how, bool with_old,
              Environment environment) {
  bench.reset(writer, with_old);
  const int n_calls = bench.count(writer.arguments, environment).writes;
  const std::map<std::string, std::string> whole = bench.files();
  REQUIRE(whole.size() == writer.targets.size());
  for (int k = 1; k <= n_calls; ++k) {
    bench.reset(writer, with_old);
    environment["FAULT_WRITE"] = std::to_string(k) + ":" + how;
    const Ended ended = bench.run(writer.arguments, environment);
    INFO(writer.name << ", call " << k << " " << how << ": exit " << ended.exit_code << " signal "
                     << ended.signal << "\n"
                     << ended.err);
    if (how == "ENOSPC" || how == "EIO") {
      REQUIRE(ended.exit_code == 5);
      REQUIRE(is_given(ended, writer));
    } else {
      REQUIRE(ended.exit_code == 0);
      REQUIRE(bench.files() == whole);
    }
    check_whole(bench, writer, with_old, whole);
  }
  return n_calls;
}

void fail_all(const Writer& writer) {
  const FaultBench bench;
  REQUIRE(bench.run({"elastic", "log.csv", "--out", ".", "--json", "stage1.json"}, {}).exit_code ==
          0);
  int n_runs = 0;
  for (const char* how : {"ENOSPC", "short", "EINTR"}) {
    n_runs += fail_each(bench, writer, how, true, {});
  }
  n_runs += fail_each(bench, writer, "EIO", false, {});
  for (const bool with_old : {false, true}) {
    n_runs += fail_each(bench, writer, "ENOSPC", with_old, {{"FAULT_NO_NAMELESS", "1"}});
  }
  std::printf("    %s: %d runs, one call failing in each\n", writer.name.c_str(), n_runs);
}

TEST_CASE("values of a JSON log that find no room are told with what to do") {
  const FaultBench bench;
  std::string values = "0";
  for (int k = 1; k < 200'000; ++k) values += "," + std::to_string(k % 100);
  std::ofstream(bench.path("log.json")) << "{\"sample_rate\": 1000, \"channels\": {\"theta\": ["
                                        << values << "], \"tau\": [" << values << "]}}";
  // The first call opens the temporary file, the second writes to it.
  const Ended ended =
      bench.run({"check", "log.json"}, {{"FAULT_WRITE", "2:ENOSPC"}, {"TMPDIR", bench.path(".")}});
  CHECK(ended.exit_code == 5);
  CHECK(ended.err == "cannot write a temporary file in " + bench.path(".") +
                         ": No space left on device; set TMPDIR to a folder with room\n");
}

TEST_CASE("elastic while a write fails") { fail_all(writers().at(0)); }
TEST_CASE("dynamic while a write fails") { fail_all(writers().at(1)); }
TEST_CASE("simulate while a write fails") { fail_all(writers().at(2)); }
TEST_CASE("check while a write fails") { fail_all(writers().at(3)); }
TEST_CASE("identify while a write fails") { fail_all(writers().at(4)); }

}  // namespace
