#include "cablefit/base/catalog.hpp"

#include <array>
#include <catch2/catch.hpp>

namespace cablefit {
namespace {

constexpr std::array<std::string_view, 4> kNames{"stribeck", "cogging", "tau", "preload"};

}  // namespace

TEST_CASE("the nearest name is found across insertions, deletions, changes and swaps") {
  CHECK(nearest_name("stribek", kNames) == "stribeck");
  CHECK(nearest_name("coggging", kNames) == "cogging");
  CHECK(nearest_name("preloax", kNames) == "preload");
  CHECK(nearest_name("tua", kNames) == "tau");
  CHECK(nearest_name("COGGING", kNames) == "cogging");
}

TEST_CASE("a name that is far from all known ones has no nearest one") {
  CHECK_FALSE(nearest_name("viscous", kNames));
  CHECK_FALSE(nearest_name("ua", std::array<std::string_view, 1>{"t"}));
  CHECK_FALSE(nearest_name("", kNames));
  CHECK_FALSE(nearest_name(std::string(5000, 'x'), kNames));
}

TEST_CASE("the nearest of several near names wins, and the first among equals") {
  constexpr std::array<std::string_view, 3> names{"theta2", "theta1", "theta"};
  CHECK(nearest_name("theta1", names) == "theta1");
  CHECK(nearest_name("theta3", names) == "theta2");
}

TEST_CASE("a suggestion names the near match or else everything") {
  CHECK(suggestion("stribck", kNames) == "did you mean 'stribeck'?");
  CHECK(suggestion("xyz", kNames) == "known: stribeck, cogging, tau, preload");
}

}  // namespace cablefit
