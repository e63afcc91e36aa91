// Preloads out of equilibrium, (8c), and the nearest that are in it: projections by hand.
#include <catch2/catch.hpp>

#include "cablefit/design/loads/pose_stiffness.hpp"
#include "cablefit/model/equilibrium.hpp"

namespace {

using namespace cablefit;
using Catch::Matchers::WithinAbs;

/// Linear cables of 1000 N m/rad in joint space, on the sides that `sign` says, with these
/// tensions.
Transmission cables_with(const std::vector<double>& sign, const std::vector<double>& tension) {
  Transmission t = antagonist_pair(1);
  const Cable one = t.cables.front();
  t.cables.clear();
  for (std::size_t k = 0; k < sign.size(); ++k) {
    Cable cable = one;
    cable.name = std::to_string(k + 1);
    cable.coefficients = {1000};
    cable.initial_elongation = tension[k] / 1000;
    cable.motor_map = cable.link_map = {round_pulley(sign[k])};
    t.cables.push_back(cable);
  }
  return t;
}

// P = S = [1, -1]: 6 - 9 = -3 N m, of a sum of 15; nearest: 7.5 on both.
TEST_CASE("an unbalanced pair meets in the middle", "[design]") {
  const Transmission pair = cables_with({1, -1}, {6, 9});
  const std::vector<Imbalance> found = imbalances(pair);
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].link, WithinAbs(-3, 1e-12));
  CHECK_THAT(found[0].motor, WithinAbs(-3, 1e-12));
  CHECK_THAT(found[0].share, WithinAbs(0.2, 1e-12));
  CHECK(
      imbalance_text(found[0], 1, Axes::rotary) ==
      "the preload is not in equilibrium, (8c): it makes -3 N m on the link and -3 N m on the "
      "motor, 20 % of the sum of the cable torques; `cablefit design --balance` gives the nearest "
      "preload in equilibrium");
  const Balance balance = nearest_balance(pair);
  CHECK_THAT(balance.link(0), WithinAbs(-3, 1e-12));
  for (const BalancedCable& cable : balance.cables) {
    CHECK_THAT(cable.balanced_tension, WithinAbs(7.5, 1e-9));
    CHECK_THAT(cable.balanced_l_o, WithinAbs(0.0075, 1e-12));
  }
}

// The plain projection of (1, 0.2, 5) onto f1 = f2 + f3 is (2.4, -1.2, 3.6); with f2 >= 0 it is
// (3, 0, 3).
TEST_CASE("no cable of the nearest balance pushes", "[design]") {
  const Balance balance = nearest_balance(cables_with({1, -1, -1}, {1, 0.2, 5}));
  const double expected[] = {3, 0, 3};
  for (std::size_t k = 0; k < 3; ++k)
    CHECK_THAT(balance.cables[k].balanced_tension, WithinAbs(expected[k], 1e-9));
}

TEST_CASE("a balanced preload stays, and is not warned about", "[design]") {
  const Transmission pair = cables_with({1, -1}, {8, 8});
  CHECK(imbalances(pair).empty());
  CHECK(imbalances(cables_with({1, -1}, {0, 0})).empty());
  CHECK_THAT(nearest_balance(pair).cables[0].balanced_l_o, WithinAbs(0.008, 1e-12));
}

// All on one side: nothing but no tension at all is in equilibrium.
TEST_CASE("cables that cannot hold each other are balanced without tension", "[design]") {
  for (const BalancedCable& cable : nearest_balance(cables_with({1, 1}, {6, 9})).cables)
    CHECK(cable.balanced_tension == 0);
}

}  // namespace
