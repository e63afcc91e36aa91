// A finger whose cables rub on the pulleys that they pass, without other friction.
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/model/rig.hpp"
#include "tests/simulate/benches.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

constexpr double kJLink[] = {4e-3, 1.5e-3}, kJMotor[] = {8e-4, 5e-4};

Model finger(double mu) {
  const TempFolder folder;
  const PlainRig plain = tendon_finger();
  Model model;
  model.rig = read_rig(folder.write("rig.json", rig_text(plain, "")));
  model.transmission = model.rig.transmission;
  for (std::size_t i = 0; i < plain.cables.size(); ++i)
    model.transmission.cables[i].coefficients = plain.cables[i].k;
  for (int k = 0; k < 2; ++k) {
    JointModel& joint = model.joints.emplace_back();
    joint.link = base_effects_with(Side::link, {kJLink[k], 0, 0});
    joint.motor = base_effects_with(Side::motor, {kJMotor[k], 0, 0, 0});
    EffectInstance rub{&find_candidate("path_friction", Site::link), {Estimate{}}};
    rub.parameters.front().value = mu;
    joint.added = {rub};
  }
  return model;
}

double energy(const Model& model, const SimulationResult& r, Eigen::Index row) {
  double sum = model.transmission.energy(r.q.row(row).matrix().transpose(),
                                         r.theta.row(row).matrix().transpose());
  for (Eigen::Index k = 0; k < 2; ++k)
    sum += 0.5 * (kJLink[k] * r.qd(row, k) * r.qd(row, k) +
                  kJMotor[k] * r.thetad(row, k) * r.thetad(row, k));
  return sum;
}

SimulationResult swing(double mu) {
  constexpr Eigen::Index kRows = 3000;
  SimulationInput input;
  input.period = 1e-3;
  input.tau = input.tau_load = Eigen::ArrayXXd::Zero(kRows, 2);
  input.q0 = input.theta0 = input.thetad0 = Eigen::VectorXd::Zero(2);
  input.qd0 = Eigen::Vector2d(1, -0.7);
  return simulate(finger(mu), input, {});
}

TEST_CASE("friction on the path of cables brakes a free finger", "[simulate]") {
  const Model model = finger(2e-3);
  const SimulationResult free = swing(0), braked = swing(2e-3);
  REQUIRE_FALSE(braked.diverged_at);
  const Eigen::Index last = free.q.rows() - 1;
  // Of the cables' own stretch at rest nothing is lost.
  const double rest = energy(model, free, 0) - 0.5 * (kJLink[0] + 0.49 * kJLink[1]);
  CHECK(energy(model, free, last) - rest == Approx(energy(model, free, 0) - rest).epsilon(2e-3));
  CHECK(energy(model, braked, last) - rest < 0.6 * (energy(model, braked, 0) - rest));
  // Over 100 rows it only falls: what the reversals store is less than that.
  for (Eigen::Index i = 100; i <= last; i += 100)
    CHECK(energy(model, braked, i) <= energy(model, braked, i - 100) * (1 + 1e-6));
}

}  // namespace
}  // namespace cablefit::test
