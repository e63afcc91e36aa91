// What stage 1 says of the reference pose: stiffness of several joints, and a preload that is not
// in equilibrium. Truth by plain arithmetic.
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

ElasticPreload fitted(const PlainRig& rig, const std::vector<double>& q) {
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
  bench.add_text(blocked_log(rig, q, 60, 94));
  return fit_elastic(bench.logs(), {}).preloads.at(0);
}

/// sum_i r_ij r_ik df_i/dl at l_o: motor pulleys are round, all cables taut.
double rest_stiffness_of(const PlainRig& rig, std::size_t j, std::size_t k) {
  double sum = 0;
  for (const PlainCable& cable : rig.cables) {
    double slope = 0;
    for (std::size_t n = 0; n < cable.k.size(); ++n)
      slope +=
          static_cast<double>(n + 1) * cable.k[n] * std::pow(cable.l_o, static_cast<double>(n));
    sum += cable.motor[j].slope(0) * cable.motor[k].slope(0) * slope;
  }
  return sum;
}

void check_rest(const PlainRig& rig) {
  const ElasticFit poly = *fitted(rig, std::vector<double>(rig.n(), 0.1)).find("poly");
  NamedValues truth;
  for (std::size_t j = 0; j < rig.n(); ++j)
    for (std::size_t k = j; k < rig.n(); ++k) {
      const double value = rest_stiffness_of(rig, j, k);
      const std::string name = fmt::format("K_rest[{},{}]", j + 1, k + 1);
      if (find_estimate(poly.derived, name) != nullptr || value != 0)
        truth.emplace_back(name, value);
    }
  CHECK(truth.size() >= rig.n());
  check_recovered(poly.derived, truth, 4);
}

TEST_CASE("several joints have a stiffness matrix at rest", "[elastic]") {
  check_rest(three_coupled_cables());
  check_rest(tendon_finger());
}

// 0.03 m of 2e5 N/m: 6 N m a mm; l_o of 1 and 2 mm make -6 N m, a third of 18.
TEST_CASE("a preload out of equilibrium is warned about with its torque", "[elastic]") {
  PlainRig rig;
  rig.joints = {PlainJoint{}};
  rig.joints[0].offset = 0;
  rig.cables = {{"a", {round_map(0.03)}, {round_map(0.03)}, {2e5}, 1e-3},
                {"b", {round_map(-0.03)}, {round_map(-0.03)}, {2e5}, 2e-3}};
  const ElasticPreload unbalanced = fitted(rig, {0});
  print_all("warning", unbalanced.warnings);
  CHECK(warns(unbalanced.warnings, "the preload is not in equilibrium, (8c): it makes -6"));
  CHECK(warns(unbalanced.warnings, "33 % of the sum of the cable torques"));
  rig.cables[0].l_o = 2e-3;
  CHECK_FALSE(warns(fitted(rig, {0}).warnings, "equilibrium"));
}

}  // namespace
