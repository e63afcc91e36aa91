// The example at the end of each command's --help works on the data of the repository.
#include <catch2/catch.hpp>

#include "tests/cli/case_file.hpp"

namespace {

using namespace cablefit::test;

std::string output_of(const std::string& command) {
  Case wanted;
  wanted.run = command;
  const Outcome outcome = run_case(wanted);
  REQUIRE(outcome.exit_code == 0);
  return outcome.out;
}

/// Names of the commands, from `cablefit --help`.
std::vector<std::string> command_names() {
  std::vector<std::string> names;
  const std::string help = output_of("cablefit --help");
  const auto start = help.find("Commands:\n") + 10;
  for (auto at = start; help[at] == ' '; at = help.find('\n', at) + 1) {
    const auto first = help.find_first_not_of(' ', at);
    names.push_back(help.substr(first, help.find(' ', first) - first));
  }
  return names;
}

std::string example_of(const std::string& command) {
  const std::string help = output_of("cablefit " + command + " --help");
  const auto start = help.find("\nExample");
  INFO(help);
  REQUIRE(start != std::string::npos);
  const auto line = help.find("\n  cablefit", start) + 3;
  return help.substr(line, help.find('\n', line) - line);
}

TEST_CASE("the examples of --help work") {
  const std::vector<std::string> names = command_names();
  REQUIRE(names.size() >= 4);
  for (const std::string& name : names) {
    Case example;
    example.run = example_of(name);
    example.prepare = {"ln -s '" CABLEFIT_DATA "' data"};
    if (name == "dynamic" || example.run.find("cablefit-out/") != std::string::npos) {
      example.prepare.push_back(
          "cablefit elastic data/low/blocked.csv data/high/blocked.csv --quiet 2> log");
      example.prepare.push_back("cablefit dynamic data/*/moving*.csv --quiet 2> log");
    }
    INFO(example.run);
    const Outcome outcome = run_case(example);
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK(!outcome.out.empty());
  }
}

}  // namespace
