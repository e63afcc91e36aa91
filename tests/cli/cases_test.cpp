// Command, exit code, exact text and files: see case_file.hpp.
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>

#include "tests/cli/case_file.hpp"

namespace {

using namespace cablefit::test;

void check(const Case& wanted) {
  INFO(wanted.place << ": " << wanted.name);
  const Outcome outcome = run_case(wanted);
  CHECK(outcome.exit_code == wanted.exit_code);
  CHECK(outcome.err == wanted.err);
  CHECK(outcome.created == wanted.creates);
  if (wanted.says.empty()) CHECK(outcome.out == wanted.out);
  for (const std::string& line : wanted.says) {
    CHECK_THAT("\n" + outcome.out, Catch::Matchers::Contains("\n" + line));
  }
}

void check_file(const std::string& name) {
  for (const Case& wanted : read_cases(CABLEFIT_SOURCE "/tests/cli/cases/" + name)) check(wanted);
}

TEST_CASE("mistakes on the command line") { check_file("usage.txt"); }
TEST_CASE("logs that cannot be used") { check_file("bad_logs.txt"); }
TEST_CASE("rig files, results and targets that cannot be used") { check_file("bad_files.txt"); }
TEST_CASE("logs and files made to do harm") { check_file("hostile.txt"); }
TEST_CASE("what works") { check_file("works.txt"); }
TEST_CASE("refine") { check_file("refine.txt"); }
TEST_CASE("campaigns") { check_file("batch.txt"); }
TEST_CASE("a prediction") { check_file("predict.txt"); }
TEST_CASE("a campaign to begin with") { check_file("init.txt"); }

TEST_CASE("every case file is run") {
  std::set<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(CABLEFIT_SOURCE "/tests/cli/cases")) {
    names.insert(entry.path().filename().string());
  }
  CHECK(names == std::set<std::string>{"bad_files.txt", "bad_logs.txt", "batch.txt", "hostile.txt",
                                       "init.txt", "predict.txt", "refine.txt", "usage.txt",
                                       "works.txt"});
}

}  // namespace
