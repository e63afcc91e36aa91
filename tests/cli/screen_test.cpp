// What the terminal shows without --verbose: the answer first, in 40 lines of 100 characters.
#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "cablefit/report/parts/escape.hpp"
#include "cablefit/report/writers/wrap.hpp"
#include "tests/cli/case_file.hpp"

namespace {

using namespace cablefit::test;

constexpr std::size_t kMostLines = 40;

Outcome run(const std::string& command) {
  Case wanted;
  wanted.place = "screen";
  wanted.name = command;
  wanted.prepare = {"cp -r '" CABLEFIT_DATA "' data",
                    "cablefit elastic --quiet data/*/blocked.csv --out cablefit-out 2> log"};
  wanted.run = command;
  return run_case(wanted);
}

TEST_CASE("what a terminal shows of the shipped examples fits on it") {
  for (const char* command :
       {"cablefit study data/low/*.csv --draws 4", "cablefit check data/low/*.csv",
        "cablefit check data/low/*.csv data/high/*.csv",
        "cablefit elastic data/low/blocked.csv data/high/blocked.csv",
        "cablefit dynamic data/low/moving*.csv data/high/moving*.csv",
        "cablefit dynamic data/low/moving_load30.csv --validate data/low/moving_load-40.csv",
        "cablefit dynamic data/low/moving*.csv --model poly --sweep",
        "cablefit identify data/low/*.csv", "cablefit refine data/low/*.csv --draws 4",
        "cablefit dynamic data/low/moving*.csv --quiet 2> log; "
        "cablefit simulate cablefit-out/dynamic.json data/low/moving_load30.csv",
        "cablefit dynamic data/low/moving*.csv --quiet 2> log; "
        "cablefit design cablefit-out/dynamic.json --model poly --torque 20",
        "cablefit batch data/campaign.json", "cablefit init data/low --dry-run",
        "cablefit --help"}) {
    INFO(command);
    const Outcome outcome = run(command);
    CHECK(outcome.exit_code == 0);
    std::istringstream text(outcome.out);
    std::size_t n_lines = 0;
    for (std::string line; std::getline(text, line); ++n_lines) {
      INFO(line);
      CHECK(cablefit::n_characters(line) <= cablefit::kTextWidth);
    }
    CHECK(n_lines <= kMostLines);
  }
}

TEST_CASE("help fits on a terminal") {
  for (const char* name : {"study", "check", "elastic", "dynamic", "identify", "simulate",
                           "predict", "refine", "design", "compare", "batch", "init", "list"}) {
    const Outcome outcome = run(std::string("cablefit ") + name + " --help");
    INFO(name);
    std::istringstream text(outcome.out);
    for (std::string line; std::getline(text, line);) {
      INFO(line);
      CHECK(cablefit::n_characters(line) <= cablefit::kTextWidth);
    }
  }
}

}  // namespace
