// A free oscillation without torque: ratios to J_link, and a word for everything else.
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kStiffness = 610, kDamping = 0.7;  // K/J_link (1/s^2), f_v/J_link (1/s)

/// q'' = -K/J q - f_v/J q' -+ f_s/J from q0 = 0.3 rad at rest, hub held at theta = 0. Between two
/// turning points it is a damped sine about -+ f_s/K, in closed form.
Columns oscillation(double coulomb) {
  Columns log{{{"t", {}}, {"q", {}}, {"theta", {}}}};
  const double decay = kDamping / 2;
  const double omega = std::sqrt(kStiffness - decay * decay);
  const double half = std::numbers::pi / omega;
  double start = 0.3, t0 = 0, side = 1;  // moving down first: friction pushes up
  for (int i = 0; i < 3000; ++i) {
    const double t = 1e-3 * i;
    while (t - t0 >= half) {
      const double centre = side * coulomb / kStiffness;
      start = centre - (start - centre) * std::exp(-decay * half);
      t0 += half;
      side = -side;
    }
    const double centre = side * coulomb / kStiffness, s = t - t0;
    const double q = centre + (start - centre) * std::exp(-decay * s) *
                                  (std::cos(omega * s) + decay / omega * std::sin(omega * s));
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(1e-5 * std::round(q / 1e-5));
    log.columns[2].second.push_back(0);
  }
  return log;
}

DynamicFit fit(const Columns& log) {
  Bench bench;
  bench.add_text(log.csv());
  return fit_dynamic(bench.logs(), {}, {}).preloads.at(0).fits.at(0);
}

TEST_CASE("ratios of a free oscillation with viscous damping", "[dynamic]") {
  const DynamicFit found = fit(oscillation(0));
  CHECK(found.model == "ratios");
  const Estimate& k = estimate(found.parameters, "K/J_link");
  const Estimate& d = estimate(found.parameters, "f_v/J_link");
  std::printf("  ratios: K/J %.3f (610), f_v/J %.4f (0.7)\n", k.value, d.value);
  CHECK_THAT(k.value, Catch::WithinRel(kStiffness, 0.02));
  CHECK_THAT(d.value, Catch::WithinRel(kDamping, 0.02));
  CHECK(estimate(found.parameters, "f_s/J_link").ci_low <= 0);
  for (const char* name : {"J_link", "J_motor", "f_v", "f_s", "f_vm", "f_sm", "offset"}) {
    const Estimate& e = estimate(found.parameters, name);
    CHECK(e.not_identifiable == "no torque is measured: only ratios to J_link can be identified");
    CHECK(std::isnan(e.value));
  }
}

TEST_CASE("ratios of a free oscillation with Coulomb friction", "[dynamic]") {
  const double coulomb = 1.5;  // rad/s^2: takes 5 mrad from every half swing, 30 mrad are left
  const DynamicFit found = fit(oscillation(coulomb));
  const Estimate& k = estimate(found.parameters, "K/J_link");
  const Estimate& c = estimate(found.parameters, "f_s/J_link");
  std::printf("  ratios: K/J %.3f (610), f_s/J %.4f (1.5)\n", k.value, c.value);
  CHECK_THAT(k.value, Catch::WithinRel(kStiffness, 0.02));
  // The filter's blur of a reversal: within 5 %.
  CHECK_THAT(c.value, Catch::WithinRel(coulomb, 0.05));
}

}  // namespace
