// Logs and rig files that are plausible and wrong: the first message names the cause, and the copy
// that is right passes without a word. The rows are in rows.txt.
#include <catch2/catch.hpp>

#include "tests/cli/case_file.hpp"

namespace {

using namespace cablefit::test;

TEST_CASE("wrong signs, units and columns are named") {
  const std::vector<Case> rows = read_cases(CABLEFIT_SOURCE "/tests/traps/rows.txt");
  std::size_t n_traps = 0;
  for (const Case& row : rows) {
    INFO(row.place << ": " << row.name);
    const Outcome outcome = run_case(row);
    CHECK(outcome.exit_code == row.exit_code);
    CHECK(outcome.err == row.err);
    CHECK(outcome.created == row.creates);
    n_traps += !row.err.empty();
  }
  CHECK(n_traps >= 45);
}

}  // namespace
