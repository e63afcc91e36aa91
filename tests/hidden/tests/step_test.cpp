#include "step.hpp"

#include <catch2/catch.hpp>

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using hidden::slide;
using hidden::Slide;

TEST_CASE("a side at rest stays exactly at rest while the torque is within its friction") {
  for (const double torque : {-2.0, -1.0, 0.0, 3.0}) {
    const Slide after = slide(0, 0.5, 1, torque, 2, 3, 1e-3);
    CHECK(after.v == 0);
    CHECK(after.dx == 0);
  }
  CHECK(slide(0, 0.5, 0, 3.5, 2, 3, 1e-3).v > 0);
  CHECK(slide(0, 0.5, 0, -2.5, 2, 3, 1e-3).v < 0);
}

TEST_CASE("without viscous friction a step is the textbook's, whatever its length") {
  // a = (5 - 3)/0.5 from rest; from v = -1: a = (1 + 2)/0.5, still sliding after 0.1 s.
  CHECK_THAT(slide(0, 0.5, 0, 5, 2, 3, 0.1).v, WithinRel(0.4, 1e-14));
  CHECK_THAT(slide(0, 0.5, 0, 5, 2, 3, 0.1).dx, WithinRel(0.02, 1e-14));
  CHECK_THAT(slide(-1, 0.5, 0, 1, 2, 3, 0.1).v, WithinRel(-0.4, 1e-14));
  CHECK_THAT(slide(-1, 0.5, 0, 1, 2, 3, 0.1).dx, WithinRel(-0.07, 1e-14));
}

TEST_CASE("a side that comes to rest within a step stops where it should, and stays") {
  // v = 0.4, deceleration (1 + 3)/0.5 = 8: at rest after 0.05 s and 0.01 rad; -1 is within [-2, 3].
  const Slide stops = slide(0.4, 0.5, 0, -1, 2, 3, 0.1);
  CHECK(stops.v == 0);
  CHECK_THAT(stops.dx, WithinRel(0.01, 1e-14));
}

TEST_CASE("a reversal within a step changes the friction where the speed is zero") {
  // As above with -5: deceleration 16 for 0.025 s, then (-5 + 2)/0.5 = -6 for 0.075 s.
  const Slide turns = slide(0.4, 0.5, 0, -5, 2, 3, 0.1);
  CHECK_THAT(turns.v, WithinRel(-0.45, 1e-14));
  CHECK_THAT(turns.dx, WithinAbs(0.005 - 0.5 * 6 * 0.075 * 0.075, 1e-15));
}
