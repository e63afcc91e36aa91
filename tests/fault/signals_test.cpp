// Runs that are ended from outside while they write: CABLEFIT_KILLS=200 in the environment for the
// full number of kills.
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "tests/fault/bench.hpp"

namespace {

using namespace cablefit::test;

int n_kills() {
  const char* text = std::getenv("CABLEFIT_KILLS");
  return text == nullptr ? 40 : std::atoi(text);
}

struct Tally {
  int killed = 0, old = 0, fresh = 0, leftovers = 0;
};

bool is_temporary(const std::string& name) {
  return name.find(".cablefit-") != std::string::npos && name.ends_with(".tmp");
}

/// Each target is old or new; counts which, and what else is there.
void take_stock(const FaultBench& bench, const std::map<std::string, std::string>& whole,
                Tally& tally) {
  for (const auto& [name, content] : bench.files()) {
    INFO(name);
    if (is_temporary(name)) {
      ++tally.leftovers;
      continue;
    }
    const auto expected = whole.find(name);
    REQUIRE(expected != whole.end());
    REQUIRE((content == expected->second || content == kOldContent));
    ++(content == kOldContent ? tally.old : tally.fresh);
  }
}

/// Each call that writes takes 5 ms, so that most signals come while files are written.
Tally strike(int signal, int n_times, Environment environment) {
  const FaultBench bench;
  const Writer writer = writers().at(0);
  environment["FAULT_WRITE_MS"] = "5";
  bench.reset(writer, true);
  const auto start = std::chrono::steady_clock::now();
  REQUIRE(bench.run(writer.arguments, environment).exit_code == 0);
  const auto usual = std::chrono::steady_clock::now() - start;
  const long usual_us = std::chrono::duration_cast<std::chrono::microseconds>(usual).count();
  const auto whole = bench.files();
  std::mt19937 engine(7);
  Tally tally;
  for (int k = 0; k < n_times; ++k) {
    INFO("signal " << signal << ", run " << k);
    bench.reset(writer, true);
    const long after = static_cast<long>(engine() % static_cast<unsigned long>(usual_us));
    const Ended ended = bench.run(writer.arguments, environment, {signal, after});
    INFO(ended.err);
    REQUIRE((ended.signal == signal || ended.exit_code == 0));
    tally.killed += ended.signal == signal;
    take_stock(bench, whole, tally);
  }
  std::printf(
      "    signal %d: %d of %d runs ended by it; %d old files, %d new, %d temporaries left\n",
      signal, tally.killed, n_times, tally.old, tally.fresh, tally.leftovers);
  return tally;
}

TEST_CASE("SIGKILL leaves whole files under every name") {
  const Tally tally = strike(SIGKILL, n_kills(), {});
  CHECK(tally.killed > n_kills() / 4);
  CHECK(tally.fresh > n_kills() / 8);  // else they all came before anything was written
  // A file has a temporary name only between two system calls, when it replaces another.
  CHECK(tally.leftovers <= n_kills());
}

TEST_CASE("SIGKILL where files cannot be nameless leaves nothing half under a final name") {
  strike(SIGKILL, n_kills() / 4, {{"FAULT_NO_NAMELESS", "1"}});
}

TEST_CASE("SIGINT, SIGTERM and SIGHUP end a run by the signal, and leave no temporary") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    CHECK(strike(signal, n_kills() / 4, {}).leftovers == 0);
    CHECK(strike(signal, n_kills() / 4, {{"FAULT_NO_NAMELESS", "1"}}).leftovers == 0);
  }
}

TEST_CASE("the next run removes what a killed one left, and nothing that is in use") {
  const FaultBench bench;
  const Writer writer = writers().at(0);
  bench.reset(writer, true);
  const std::string left = bench.path("out/.cablefit-1-0.tmp");
  const std::string young = bench.path("out/.cablefit-1-1.tmp");
  const std::string other = bench.path("out/.cablefit-notes.txt");
  for (const std::string& path : {left, young, other}) std::ofstream(path) << "half";
  const auto an_hour_ago = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(left, an_hour_ago);
  REQUIRE(bench.run(writer.arguments, {}).exit_code == 0);
  CHECK(!std::filesystem::exists(left));
  CHECK(std::filesystem::exists(young));
  CHECK(std::filesystem::exists(other));
}

}  // namespace
