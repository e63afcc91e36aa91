#include "plant.hpp"

#include "random.hpp"

namespace hidden {
namespace {

/// The root of an increasing function between lo and hi.
template <typename Function>
double bisect(Function f, double lo, double hi) {
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (lo + hi);
    (f(mid) < 0 ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

}  // namespace

Rig rig_of_seed(std::uint64_t seed) {
  Rig rig;
  if (seed == 0) return rig;
  Random random(seed, "rig");
  for (double* value :
       {&rig.J_link, &rig.f_v, &rig.f_s, &rig.J_motor, &rig.f_vm, &rig.f_sm, &rig.offset,
        &rig.cable_1.c[0], &rig.cable_1.c[1], &rig.cable_2.c[0], &rig.cable_2.c[1]})
    *value *= 1 + 0.15 * random.uniform(-1, 1);
  return rig;
}

Rig preloaded(Rig rig, double l_o) {
  const double pull = rig.cable_1.torque(l_o);
  rig.cable_1.l_o = l_o;
  rig.cable_2.l_o = bisect([&](double l) { return rig.cable_2.torque(l) - pull; }, 0, 1);
  return rig;
}

double deflection_for(const Rig& rig, double torque) {
  return bisect([&](double phi) { return rig.tau_elas(phi) - torque; }, -0.1, 0.1);
}

}  // namespace hidden
