// Cables that rub on the pulleys of the joints that they pass.
#include "cablefit/model/effects/path_friction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "cablefit/model/rig.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

std::vector<Cable> cables_of(const PlainRig& plain) {
  const TempFolder folder;
  return read_rig(folder.write("rig.json", rig_text(plain, ""))).transmission.cables;
}

TEST_CASE("a cable loses tension at each pulley against its speed there", "[model]") {
  // The flexor of the hand's first finger passes three links at 10, 7 and 5 mm.
  PathFriction path(cables_of(two_finger_hand()), 0);
  CHECK_FALSE(path.is_empty());
  const std::vector<double> q(6, 0.0);
  std::vector<double> tension(10, 0.0);
  tension[0] = 50;
  // Link 1 turns so much faster the other way that the cable runs back over its pulley only:
  // v_1 = -0.02 + 0.007 + 0.005, v_2 = 0.012, v_3 = 0.005 m/s.
  const std::vector<double> qd = {-2, 1, 1, 0, 0, 0};
  path.advance(q, qd, 1);
  CHECK(path.on_link(0, q, tension) == Approx(50 * 0.010 * -1).epsilon(1e-12));
  CHECK(path.on_link(1, q, tension) == Approx(50 * 0.007 * (-1 + 1)).margin(1e-12));
  CHECK(path.on_link(2, q, tension) == Approx(50 * 0.005 * (-1 + 1 + 1)).epsilon(1e-12));
  CHECK(path.on_link(3, q, tension) == 0);  // of the other finger
}

TEST_CASE("friction on the path of cables takes energy and never gives any", "[model]") {
  PathFriction path(cables_of(two_finger_hand()), 0);
  const std::vector<double> q(6, 0.1), tension(10, 20);
  for (int step = 0; step < 200; ++step) {
    std::vector<double> qd(6);
    for (std::size_t k = 0; k < 6; ++k)
      qd[k] = std::sin(0.1 * step * (1 + 0.3 * static_cast<double>(k)));
    path.advance(q, qd, 0.01);  // long against the reversal
    double power = 0;
    for (std::size_t k = 0; k < 6; ++k) power += path.on_link(k, q, tension) * qd[k];
    CHECK(power >= 0);
  }
}

TEST_CASE("a cable turns its friction over the way of a reversal", "[model]") {
  PathFriction path(cables_of(tendon_finger()), 2e-6);
  const std::vector<double> q(2, 0.0), tension = {100, 0, 0};
  const auto after = [&](double way) {  // m over the pulley of link 2, whose radius is 7 mm
    const std::vector<double> qd = {-0.007 / 0.010 * way / 0.007, way / 0.007};
    path.advance(q, qd, 1);
    return path.on_link(1, q, tension) / (100 * 0.007);
  };
  CHECK(after(1e-3) == Approx(1).epsilon(1e-9));
  CHECK(after(-2e-6) == Approx(2 * std::exp(-1) - 1).epsilon(1e-9));
  CHECK(after(0) == Approx(2 * std::exp(-1) - 1).epsilon(1e-9));  // it sticks
}

TEST_CASE("a rig whose cables pass one joint each has no path", "[model]") {
  CHECK(PathFriction(cables_of(seven_joint_rig()), 0).is_empty());
}

}  // namespace
}  // namespace cablefit::test
