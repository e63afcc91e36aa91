// Fig. 4 of the paper from a model: two linear cables with preload, stiff while both are taut.
#include "cablefit/elastic/cable_figure.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

TEST_CASE("a preloaded pair of linear cables bends where one goes slack", "[elastic]") {
  Transmission pair = antagonist_pair(1);
  pair.cables[0].coefficients = {1000};
  pair.cables[1].coefficients = {1500};
  pair.cables[0].initial_elongation = 0.006;  // K1 l_o1 = K2 l_o2: in equilibrium
  pair.cables[1].initial_elongation = 0.004;
  const Figure figure = cable_figure(pair, -0.02, 0.02, false);
  REQUIRE(figure.traces.size() == 3);
  const Trace &all = figure.traces[0], &first = figure.traces[1], &second = figure.traces[2];
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    const double phi = all.x[i];
    const double expected =
        (phi > -0.006 ? 1000 * (phi + 0.006) : 0) - (phi < 0.004 ? 1500 * (0.004 - phi) : 0);
    CHECK_THAT(all.y[i], Catch::WithinAbs(expected, 1e-12));
    CHECK_THAT(first.y[i] + second.y[i], Catch::WithinAbs(expected, 1e-12));
    CHECK(first.y[i] >= 0);  // a cable only pulls
    CHECK(second.y[i] <= 0);
  }
  REQUIRE(figure.marks.size() == 2);
  CHECK_THAT(figure.marks[0].x, Catch::WithinAbs(-0.006, 1e-12));
  CHECK(figure.marks[0].text == "1");
  CHECK_THAT(figure.marks[1].x, Catch::WithinAbs(0.004, 1e-12));
  CHECK(figure.marks[1].text == "2");

  pair.cables[0].initial_elongation = 0.0006;  // too close for two names
  pair.cables[1].initial_elongation = 0.0004;
  const std::vector<Mark> marks = cable_figure(pair, -0.02, 0.02, false).marks;
  REQUIRE(marks.size() == 2);
  CHECK(marks[0].text.empty());
  CHECK(marks[1].text == "1, 2");
}

}  // namespace
