// The share that a model explains, in words.
#include "cablefit/figure/explained.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;

TEST_CASE("an explained share has two digits of what is not explained") {
  CHECK(explained_percent(100, 100) == "0 %");
  CHECK(explained_percent(100, 250) == "0 %");
  CHECK(explained_percent(100, 32) == "68 %");
  CHECK(explained_percent(100, 1.34) == "98.7 %");
  CHECK(explained_percent(1, 1.7e-4) == "99.983 %");
  CHECK(explained_percent(1, 0) == "100 %");
  CHECK(explained_percent(0, 0) == "-");
  CHECK(explained_percent(1, std::nan("")) == "-");
}

TEST_CASE("of a torque about zero, of a position about its mean") {
  Explained explained;
  for (const double measured : {9.0, 11.0}) explained.add(measured, 0.5);
  // Squares: 202 about zero, 2 about the mean of 10; residual 0.5.
  CHECK(explained.of_squares() == "99.75 %");
  CHECK(explained.about_mean() == "75 %");
}

}  // namespace
