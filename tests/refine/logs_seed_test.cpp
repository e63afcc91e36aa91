// The seed of simulated data sets goes with what the logs say, not with how they are stored.
#include "cablefit/refine/null/logs_seed.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Ten rows in which theta rises to `last`.
std::string log_text(const char* last) {
  std::string text = "t,q,theta,tau\n";
  for (int k = 0; k < 9; ++k)
    text += "0.00" + std::to_string(k) + ",0.0," + "0.0" + std::to_string(k) + ",1.0\n";
  return text + "0.009,0.0," + last + ",1.0\n";
}

std::uint64_t seed_of(const std::string& text, std::uint64_t seed = 1) {
  Bench bench;
  bench.add_text(text);
  return seed_for(bench.logs(), seed);
}

TEST_CASE("other logs draw other random numbers, the same logs the same", "[refine]") {
  const std::uint64_t seed = seed_of(log_text("0.09"));
  CHECK(seed == seed_of(log_text("0.09")));
  CHECK(seed == seed_of(log_text("0.0900")));
  CHECK(seed != seed_of(log_text("0.091")));
  CHECK(seed != seed_of(log_text("0.09"), 2));
}

TEST_CASE("the order of the logs does not change the seed", "[refine]") {
  Bench one, other;
  one.add_text(log_text("0.09"));
  one.add_text(log_text("0.091"));
  other.add_text(log_text("0.091"));
  other.add_text(log_text("0.09"));
  CHECK(seed_for(one.logs(), 1) == seed_for(other.logs(), 1));
}

}  // namespace
