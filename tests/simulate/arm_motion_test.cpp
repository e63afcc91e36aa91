// Links that move each other: against integrators of other kinds, by energy, at rest and in motion.
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/simulate/arm_step.hpp"
#include "tests/simulate/arm_models.hpp"
#include "tests/support/stick_slip.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// The phalanges with these frictions: shares of f_s and f_sm of the plain rig.
PlainRig finger(double dry) {
  PlainRig rig = phalanges_rig();
  for (PlainJoint& joint : rig.joints) {
    joint.f_s *= dry;
    joint.f_sm *= dry;
  }
  return rig;
}

constexpr double kFingerP = 6, kFingerD = 0.06;  // of the finger's controllers

/// Row by row, the motor torque of the rig's controller at `theta` (drive.hpp's law: backward
/// differences, the position before the first row by the first reference).
class PlainController {
 public:
  explicit PlainController(const Eigen::ArrayXXd& reference, double period)
      : reference_(reference), period_(period) {}

  std::vector<double> torque(Eigen::Index row, const PlainState& x, std::size_t n) {
    std::vector<double> tau(n);
    error_.resize(n);
    for (std::size_t j = 0; j < n; ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      const double error = reference_(row, k) - x[2 * n + j];
      if (row == 0) error_[j] = reference_(0, k) - reference_(1, k) + reference_(0, k);
      tau[j] = kFingerP * error + kFingerD * (error - error_[j]) / period_;
      error_[j] = error;
    }
    return tau;
  }

 private:
  const Eigen::ArrayXXd& reference_;
  double period_;
  std::vector<double> error_;
};

SimulationInput following(Eigen::Index rows, double period, Eigen::Index n_joints, double size) {
  SimulationInput input = quiet_input(rows, period, n_joints);
  input.theta_ref = swinging(rows, period, n_joints, size);
  return input;
}

SimulationOptions in_closed_loop(double step) {
  SimulationOptions options = step_of(step);
  options.closed_loop = true;
  return options;
}

constexpr Eigen::Index kArmRows = 10001;  // 10 s at 1 kHz

/// Largest difference of positions, rad, over the rows of `reference`: q and theta of each.
double largest_difference(const SimulationResult& simulated,
                          const std::vector<PlainState>& reference) {
  double largest = 0;
  const Eigen::Index n = simulated.q.cols();
  for (std::size_t i = 0; i < reference.size(); ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto k = static_cast<std::size_t>(j), m = static_cast<std::size_t>(n);
      largest = std::max({largest, std::abs(simulated.q(row, j) - reference[i][k]),
                          std::abs(simulated.theta(row, j) - reference[i][2 * m + k])});
    }
  return largest;
}

TEST_CASE("a finger without dry friction moves as by a Runge-Kutta integration", "[simulate]") {
  const PlainRig plain = finger(0);
  const Model model = arm_model(plain, phalanges(), pd_text(kFingerP, kFingerD));
  const SimulationInput input = following(kArmRows, 1e-3, 2, 0.5);
  std::vector<PlainState> reference;
  PlainController controller(input.theta_ref, 1e-3);
  PlainState x(8, 0.0);
  for (Eigen::Index i = 0; i < kArmRows; ++i) {
    reference.push_back(x);
    const std::vector<double> tau = controller.torque(i, x, 2);
    for (int step = 0; step < 10; ++step) x = runge_kutta(plain, x, 10, 1e-4, tau);
  }
  const double error = largest_difference(simulate(model, input, in_closed_loop(25e-6)), reference);
  const double coarse = largest_difference(simulate(model, input, in_closed_loop(1e-4)), reference);
  std::printf("    10 s: %.2g rad with 25 us, %.2g rad with 100 us\n", error, coarse);
  CHECK(error < 2e-6);
  CHECK(std::log2(coarse / error) / 2 > 1.9);
}

TEST_CASE("a finger sticks and slips as by events", "[simulate]") {
  PlainRig plain = finger(3);
  for (PlainCable& cable : plain.cables) cable.l_o = 2e-4;  // slack on one side when loaded
  const Model model = arm_model(plain, phalanges(), pd_text(kFingerP, kFingerD));
  const SimulationInput input = following(kArmRows, 1e-3, 2, 0.15);
  std::vector<PlainState> reference;
  PlainController controller(input.theta_ref, 1e-3);
  StickSlip exact(plain, phalanges(), PlainState(8, 0.0));
  for (Eigen::Index i = 0; i < kArmRows; ++i) {
    reference.push_back(exact.state());
    const std::vector<double> tau = controller.torque(i, exact.state(), 2);
    for (int step = 0; step < 20; ++step) exact.step(tau, 5e-5);
  }
  const SimulationResult fine = simulate(model, input, in_closed_loop(25e-6));
  const double error = largest_difference(fine, reference);
  const double coarse = largest_difference(simulate(model, input, in_closed_loop(1e-4)), reference);
  const auto at_rest = (fine.qd == 0).count();
  const auto slack = (fine.tension == 0).rowwise().any().count();
  std::printf(
      "    10 s, %d stops, links at rest in %ld of %ld rows, some cable slack in %ld: "
      "%.2g rad with 25 us, %.2g rad with 100 us\n",
      exact.n_events(), static_cast<long>(at_rest), static_cast<long>(2 * kArmRows),
      static_cast<long>((fine.tension == 0).rowwise().any().count()), error, coarse);
  CHECK(exact.n_events() > 50);
  CHECK(at_rest > kArmRows / 10);
  CHECK(slack > kArmRows / 10);
  CHECK(error < 2e-6);
}

/// Energy of the phalanges with their tendons.
double finger_energy(const PlainRig& rig, const PlainArm& arm, const SimulationResult& r,
                     Eigen::Index row) {
  const Eigen::VectorXd q = r.q.row(row).matrix(), qd = r.qd.row(row).matrix();
  double sum = arm.kinetic(q, qd) + arm.potential(q);
  for (std::size_t j = 0; j < rig.n(); ++j) {
    const double speed = r.thetad(row, static_cast<Eigen::Index>(j));
    sum += 0.5 * rig.joints[j].J_motor * speed * speed;
  }
  for (const PlainCable& cable : rig.cables) {
    double l = cable.l_o;
    for (std::size_t j = 0; j < rig.n(); ++j) {
      const auto k = static_cast<Eigen::Index>(j);
      l += cable.motor[j].way(r.theta(row, k)) - cable.link[j].way(r.q(row, k));
    }
    for (std::size_t p = 0; l > 0 && p < cable.k.size(); ++p)
      sum += cable.k[p] * std::pow(l, static_cast<double>(p) + 2) / (static_cast<double>(p) + 2);
  }
  return sum;
}

/// Largest change of it over 2 s, in shares of the largest kinetic energy.
double energy_error(PlainRig rig, double step) {
  for (PlainJoint& joint : rig.joints)
    joint.f_v = joint.f_s = joint.f_vm = joint.f_sm = joint.offset = 0;
  const PlainArm arm = phalanges();
  SimulationInput input = quiet_input(2001, 1e-3, 2);
  input.q0 << 0.3, 0.5;
  input.theta0 = input.q0;
  input.qd0 << 2, -3;
  const SimulationResult result = simulate(arm_model(rig, arm), input, step_of(step));
  const double start = finger_energy(rig, arm, result, 0);
  double largest = 0, kinetic = 0;
  for (Eigen::Index i = 0; i < result.q.rows(); ++i) {
    largest = std::max(largest, std::abs(finger_energy(rig, arm, result, i) - start));
    kinetic = std::max(kinetic, arm.kinetic(result.q.row(i).matrix(), result.qd.row(i).matrix()));
  }
  return largest / kinetic;
}

TEST_CASE("a finger without friction keeps its energy with order 2", "[simulate]") {
  PlainRig loose = finger(0);
  for (PlainCable& cable : loose.cables) cable.k.assign(1, 0.0);  // the links alone
  for (const PlainRig& rig : {finger(0), loose}) {
    const double coarse = energy_error(rig, 1e-4), fine = energy_error(rig, 25e-6),
                 finest = energy_error(rig, 6.25e-6);
    std::printf("    energy: %.2g with 100 us, %.2g with 25 us, %.2g with 6.25 us\n", coarse, fine,
                finest);
    CHECK(std::log2(coarse / finest) / 4 > 1.9);
  }
}

TEST_CASE("a link that sticks stands exactly still while another moves", "[simulate]") {
  PlainRig plain = finger(1);
  plain.joints[1].f_s = 2;
  const Model model = arm_model(plain, phalanges(), pd_text(kFingerP, kFingerD));
  const SimulationResult result =
      simulate(model, following(3001, 1e-3, 2, 0.5), in_closed_loop(25e-6));
  CHECK((result.q.col(1) == 0).all());
  CHECK((result.qd.col(1) == 0).all());
  CHECK(result.q.col(0).abs().maxCoeff() > 0.2);
}

TEST_CASE("a link leaves rest by what the others' motion asks of it", "[simulate]") {
  // No cables: link 1 falls under gravity from level, link 2 is held by friction until
  // |M21 q1dd + C2 + g2| exceeds it.
  const PlainArm arm = phalanges();
  PlainRig plain = finger(0);
  for (PlainCable& cable : plain.cables) cable.k.assign(1, 0.0);
  const Eigen::Vector2d q(0.2, -0.4), rest(0, 0);
  const Eigen::Vector2d weight = arm.torques(q, rest, rest);
  const double inertia = arm.torques(q, rest, Eigen::Vector2d(1, 0))(0) - weight(0);
  const double held =
      arm.torques(q, rest, Eigen::Vector2d(-weight(0) / inertia, 0))(1);  // q2dd = 0
  for (const double share : {1.0001, 0.9999}) {
    plain.joints[1].f_s = share * std::abs(held);
    plain.joints[0].f_v = plain.joints[0].f_s = 0;
    SimulationInput input = quiet_input(2, 25e-6, 2);
    input.q0 = input.theta0 = q;
    const SimulationResult result = simulate(arm_model(plain, arm), input, step_of(25e-6));
    CHECK((result.qd(1, 1) == 0) == (share > 1));
    CHECK(result.qd(1, 0) != 0);
  }
}

/// One joint whose link has 0.05 kg m^2 about it, without gravity.
Model single_axis_arm() {
  PlainRig plain;
  plain.joints = {PlainJoint{}};
  plain.cables = {{"1", {round_map(0.03)}, {round_map(0.03)}, {6e5, 2e7}},
                  {"2", {round_map(-0.03)}, {round_map(-0.03)}, {5e5, 2e7}}};
  PlainArm arm;
  arm.links = {
      {{0, 0, 0.1}, {0.3, 0, 0}, {0, 0, 1}, 1.5, {0.1, 0, 0}, plain_tensor(0.01, 0.01, 0.035)}};
  arm.gravity.setZero();
  return arm_model(plain, arm, pd_text(60, 0.6));
}

TEST_CASE("an arm of one joint moves as a joint of its own", "[simulate]") {
  const Model coupled = single_axis_arm();
  REQUIRE(coupled.arm.size() == 1);
  Model single = coupled;
  single.arm.clear();
  single.rig.arm = {};
  const PlainJoint joint;
  single.joints[0].link = base_effects_with(Side::link, {0.05, joint.f_v, joint.f_s});
  CHECK(coupled.arm[0].value == Approx(0.05).epsilon(1e-14));
  const SimulationInput input = following(5001, 1e-3, 1, 0.2);
  const SimulationResult a = simulate(coupled, input, in_closed_loop(25e-6)),
                         b = simulate(single, input, in_closed_loop(25e-6));
  CHECK((b.qd == 0).count() > 50);
  // The instant of a stop is found by a chord instead of the damped motion: (h f_v / J)^2 of it.
  CHECK((a.q - b.q).abs().maxCoeff() < 1e-11);
}

TEST_CASE("an arm whose mass matrix is not positive definite diverges at once", "[simulate]") {
  Model model = arm_model(finger(1), phalanges());
  for (Estimate& e : model.arm)
    if (e.name == "YY2") e.value = -1e-3;
  CHECK(simulate(model, quiet_input(10, 1e-3, 2), {}).diverged_at == 0);
}

TEST_CASE("blocked links of an arm stay where they are", "[simulate]") {
  SimulationOptions options = in_closed_loop(25e-6);
  options.link_blocked = true;
  const Model model = arm_model(finger(1), phalanges(), pd_text(kFingerP, kFingerD));
  SimulationInput input = following(500, 1e-3, 2, 0.2);
  input.q0 << 0.1, -0.2;
  const SimulationResult result = simulate(model, input, options);
  CHECK((result.q.col(0) == 0.1).all());
  CHECK((result.q.col(1) == -0.2).all());
  CHECK(result.theta.abs().maxCoeff() > 0);
}

/// Circular frequency of the stiffest mode by differences of the plain rig's torques, links at 0
/// and motors at `theta`.
double plain_mode(const PlainRig& rig, const PlainArm& arm, double theta) {
  const auto torques = [&](const Eigen::Vector4d& x) -> Eigen::Vector4d {
    const std::vector<double> q{x(0), x(1)}, motors{x(2), x(3)};
    const std::vector<double> link = link_torques(rig, q, motors),
                              motor = motor_torques(rig, q, motors);
    return {-link[0], -link[1], motor[0], motor[1]};
  };
  const Eigen::Vector2d zero(0, 0);
  Eigen::Matrix4d stiffness, inertia = Eigen::Matrix4d::Zero();
  for (Eigen::Index k = 0; k < 4; ++k) {
    const Eigen::Vector4d at(0, 0, theta, theta), by = 1e-6 * Eigen::Vector4d::Unit(k);
    stiffness.col(k) = (torques(at + by) - torques(at - by)) / 2e-6;
  }
  for (Eigen::Index k = 0; k < 2; ++k) {
    inertia.block<2, 1>(0, k) =
        arm.torques(zero, zero, Eigen::Vector2d::Unit(k)) - arm.torques(zero, zero, zero);
    inertia(2 + k, 2 + k) = rig.joints[static_cast<std::size_t>(k)].J_motor;
  }
  // Both are symmetric: of L^-1 K L^-T with inertia = L L^T.
  const Eigen::MatrixXd half = Eigen::Matrix4d(inertia.llt().matrixL()).inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(half * stiffness * half.transpose());
  return std::sqrt(modes.eigenvalues().maxCoeff());
}

TEST_CASE("the step of an arm goes by its stiffest mode", "[simulate]") {
  // K on both sides of one joint: omega^2 = K (1/J_motor + 1/J_link).
  Model model = single_axis_arm();
  model.transmission = classical_spring(model.transmission);
  model.transmission.linear_stiffness[0] = 800;
  CHECK(stiffest_mode(model) == Approx(std::sqrt(800 / 0.005 + 800 / 0.05)).epsilon(1e-12));
  CHECK(arm_step(100) == 50e-6);
  CHECK(arm_step(1000) == Approx(30e-6).epsilon(1e-14));
  CHECK(arm_step(1e5) == 25e-6);
  CHECK(arm_step(0) == 25e-6);
  const PlainRig plain = finger(1);
  const double mode = stiffest_mode(arm_model(plain, phalanges()));
  const double expected =
      std::max(plain_mode(plain, phalanges(), 1e-3), plain_mode(plain, phalanges(), -1e-3));
  CHECK(mode == Approx(expected).epsilon(1e-7));  // differences of 1e-6 rad
}

/// `model` with a row on its second joint; values of the linear parameters, shapes mid-grid.
Model refined_finger(Model model, const Effect& row, double value) {
  EffectInstance instance;
  instance.effect = &row;
  for (std::size_t i = 0; i < row.parameters.size(); ++i) {
    Estimate& e = instance.parameters.emplace_back();
    e.name = row.parameters[i].name;
    const ShapeGrid* grid = i < row.n_linear() ? nullptr : &row.shape[i - row.n_linear()];
    const LogScale scale{.peak = 1, .travel = 0.4, .speed = 2.5, .deflection = 0.03};
    e.value = grid == nullptr ? value : grid->value(grid->n_values / 2, scale);
  }
  model.joints[1].added = {instance};
  return model;
}

TEST_CASE("refinements of a joint act on a coupled arm", "[simulate]") {
  const Model model = arm_model(finger(1), phalanges(), pd_text(kFingerP, kFingerD));
  const SimulationInput input = following(301, 1e-3, 2, 0.3);
  const SimulationResult plain = simulate(model, input, in_closed_loop(50e-6));
  for (const Effect& row : candidate_effects()) {
    if (!row.torque && !row.level) continue;
    INFO(row.name << " " << to_string(row.site));
    const auto moved = [&](double value) {
      const SimulationResult r =
          simulate(refined_finger(model, row, value), input, in_closed_loop(50e-6));
      return (r.q - plain.q).abs().maxCoeff();
    };
    CHECK(moved(0) < 1e-15);
    if (row.site == Site::link && !row.is_event) CHECK(moved(1e-3) > 1e-9);
  }
}

}  // namespace
