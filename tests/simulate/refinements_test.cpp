// Models with refinements: every row of the catalogue does in a simulation what its regressor says.
#include "cablefit/model/effects.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "tests/simulate/benches.hpp"
#include "tests/simulate/true_models.hpp"
#include "tests/support/recorded_log.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;
using Values = std::vector<double>;

constexpr double kStep = 1e-4;  // s, of rows and of the simulation
constexpr double kEvent = 1.0;  // s

std::string label(const Effect& row) {
  return std::string(row.name) + " of the " + std::string(to_string(row.site));
}

/// The shape in the middle of the grids.
Values middle_shape(const Effect& row) {
  Values shape;
  for (const ShapeGrid& grid : row.shape)
    shape.push_back(grid.value(grid.n_values / 2,
                               {.peak = 1, .travel = 0.4, .speed = 2.5, .deflection = 0.03}));
  return shape;
}

EffectInstance instance_of(const Effect& row, const Values& linear, const Values& shape) {
  EffectInstance instance;
  instance.effect = &row;
  instance.event_time = kEvent;
  for (std::size_t i = 0; i < row.parameters.size(); ++i) {
    Estimate& estimate = instance.parameters.emplace_back();
    estimate.name = row.parameters[i].name;
    estimate.value = i < linear.size() ? linear[i] : shape.at(i - linear.size());
  }
  return instance;
}

Model refined(Model model, const EffectInstance& instance) {
  model.joints[0].added = {instance};
  return model;
}

SimulationInput lively_input(Eigen::Index rows, double period) {
  SimulationInput input = quiet_input(rows, period);
  const Eigen::ArrayXd t = period * Eigen::ArrayXd::LinSpaced(rows, 0, double(rows - 1));
  input.tau = 14 * (8 * t).sin() + 5 * (45 * t).sin();
  input.tau_load = 8 * (5 * t + 1).cos();
  input.qd0[0] = input.thetad0[0] = 0.1;
  return input;
}

/// Torques per unit of each linear parameter (columns) in every step of a motion, and what the
/// friction's sign makes of a level. The states are the test's own.
struct Regressor {
  Eigen::ArrayXXd link, motor;
};

JointState middle(const Model& model, const SimulationInput& input, const SimulationResult& motion,
                  Eigen::Index i) {
  JointState state;
  const auto mean = [i](const Eigen::ArrayXXd& v) { return 0.5 * (v(i, 0) + v(i + 1, 0)); };
  state.t = (static_cast<double>(i) + 0.5) * kStep;
  state.since_event = state.t - kEvent;
  state.q = motion.q(i, 0) + 0.5 * kStep * motion.qd(i, 0);
  state.theta = motion.theta(i, 0) + 0.5 * kStep * motion.thetad(i, 0);
  state.qd = mean(motion.qd);
  state.thetad = mean(motion.thetad);
  state.qdd = (motion.qd(i + 1, 0) - motion.qd(i, 0)) / kStep;
  state.thetadd = (motion.thetad(i + 1, 0) - motion.thetad(i, 0)) / kStep;
  state.deflection_rate = state.thetad - state.qd;
  if (model.rigid) {
    state.load = mean(input.tau_load);
    state.tau_elas = -state.load;
  } else {
    set_elastic(model.transmission, Eigen::VectorXd::Constant(1, state.q),
                Eigen::VectorXd::Constant(1, state.theta), 0, state);
  }
  return state;
}

Regressor regressor(const Effect& row, const Values& shape, const Model& model,
                    const SimulationInput& input, const SimulationResult& motion) {
  const Eigen::Index steps = motion.q.rows() - 1;
  const auto n = static_cast<Eigen::Index>(row.n_linear());
  Regressor columns{Eigen::ArrayXXd::Zero(steps, n), Eigen::ArrayXXd::Zero(steps, n)};
  Values z(row.n_states, 0.0);
  for (Eigen::Index i = 0; i < steps; ++i) {
    const JointState state = middle(model, input, motion, i);
    Values link(row.n_linear()), motor(row.n_linear()), level(row.n_linear());
    if (row.advance) row.advance(state, shape.data(), 0.5 * kStep, z.data());
    if (row.torque) row.torque(state, shape.data(), z.data(), link.data(), motor.data());
    const bool on_link = row.site == Site::link;
    const double sign = std::copysign(1.0, on_link ? state.qd : state.thetad);
    if (row.level) row.level(state, sign, shape.data(), z.data(), level.data());
    if (row.advance) row.advance(state, shape.data(), 0.5 * kStep, z.data());
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto j = static_cast<std::size_t>(k);
      columns.link(i, k) = link[j] + (on_link ? sign * level[j] : 0);
      columns.motor(i, k) = motor[j] + (on_link ? 0 : sign * level[j]);
    }
  }
  return columns;
}

/// J v' + f_v v + f_s sgn(v) + offset of an axis in every step; NaN where it stands or turns round.
Eigen::ArrayXd base_torque(const std::vector<EffectInstance>& effects, const Eigen::ArrayXd& v) {
  const auto value = [&](std::size_t k) {
    return k < effects.size() ? effects[k].parameters[0].value : 0;
  };
  const Eigen::Index steps = v.size() - 1;
  const Eigen::ArrayXd mean = 0.5 * (v.head(steps) + v.tail(steps));
  const Eigen::ArrayXd torque = value(0) / kStep * (v.tail(steps) - v.head(steps)) +
                                value(1) * mean + value(2) * mean.sign() + value(3);
  return (v.head(steps) * v.tail(steps) > 0)
      .select(torque, Eigen::ArrayXd::Constant(steps, std::nan("")));
}

/// What the equations of motion leave for the row: link and motor (or the only axis).
struct Leftover {
  Eigen::ArrayXd link, motor;
};

Leftover leftover(const Model& model, const SimulationInput& input,
                  const SimulationResult& motion) {
  const Eigen::Index steps = motion.q.rows() - 1;
  Eigen::ArrayXd elastic = Eigen::ArrayXd::Zero(steps);
  for (Eigen::Index i = 0; i < steps; ++i) elastic[i] = middle(model, input, motion, i).tau_elas;
  const Eigen::ArrayXd load =
      0.5 * (input.tau_load.col(0).head(steps) + input.tau_load.col(0).tail(steps));
  const Eigen::ArrayXd tau = input.tau.col(0).head(steps);  // held
  const Eigen::ArrayXd motor = base_torque(model.joints[0].motor, motion.thetad.col(0));
  if (model.rigid) return {Eigen::ArrayXd::Zero(steps), tau + load - motor};
  return {elastic + load - base_torque(model.joints[0].link, motion.qd.col(0)),
          tau - elastic - motor};
}

/// rms over what is a number.
double rms(const Eigen::ArrayXd& x) {
  double sum = 0, n = 0;
  for (const double value : x) {
    if (std::isnan(value)) continue;
    sum += value * value;
    ++n;
  }
  REQUIRE(n > 1000);
  return std::sqrt(sum / n);
}

/// Parameters of which each is worth 0.3 N m at most on the motion of the plain model.
Values typical_size(const Effect& row, const Values& shape, const Model& model,
                    const SimulationInput& input, const SimulationResult& motion) {
  const Regressor columns = regressor(row, shape, model, input, motion);
  Values size;
  for (Eigen::Index k = 0; k < columns.link.cols(); ++k)
    size.push_back(0.3 / std::max({columns.link.col(k).abs().maxCoeff(),
                                   columns.motor.col(k).abs().maxCoeff(), 1e-9}));
  return size;
}

void check_row(const Effect& row, const Model& plain) {
  const SimulationInput input = lively_input(30000, kStep);
  const SimulationOptions options = step_of(kStep);
  const Values shape = middle_shape(row);
  const Values size = typical_size(row, shape, plain, input, simulate(plain, input, options));
  const Model model = refined(plain, instance_of(row, size, shape));
  const SimulationResult motion = simulate(model, input, options);
  REQUIRE_FALSE(motion.diverged_at);
  const Regressor columns = regressor(row, shape, model, input, motion);
  const Eigen::Map<const Eigen::ArrayXd> a(size.data(), Eigen::Index(size.size()));
  Eigen::ArrayXd link = (columns.link.matrix() * a.matrix()).array();
  Eigen::ArrayXd motor = (columns.motor.matrix() * a.matrix()).array();
  if (plain.rigid) {
    motor += link;
    link.setZero();
  }
  const Leftover left = leftover(model, input, motion);
  // The integrator takes velocities half a step ahead by extrapolation: off by h^2 v''/4, and by
  // h/4 of an acceleration that jumps where a body stops or starts. 0.3 % of the torque is four
  // times the worst row; half a step's lag would be 2 % of a torque that goes with a velocity.
  CHECK(rms(motor) + rms(link) > 0.01);
  CHECK(rms(left.motor - motor) < 3e-3 * (rms(motor) + rms(link)));
  if (!plain.rigid) CHECK(rms(left.link - link) < 3e-3 * (rms(motor) + rms(link)));
}

TEST_CASE("a refinement's torque is in the simulated motion", "[simulate]") {
  for (const Effect& row : candidate_effects()) {
    if ((!row.torque && !row.level) || row.name == "load_friction") continue;  // of rigid drives
    if (row.yardstick == Yardstick::shared_cable) continue;                    // of several joints
    INFO(label(row));
    check_row(row, paper_rig_low());
    if (row.site != Site::transmission)
      check_row(row, spring_joint({0.339, 5.601, 3.274}, {0.0133, 1.0654, 2.778, 0.0286}, 1900));
  }
}

TEST_CASE("friction and position of either side act on a rigid drive", "[simulate]") {
  for (const Effect& row : candidate_effects()) {
    if ((!row.torque && !row.level) || row.name == "tension_friction") continue;  // needs cables
    if (row.yardstick == Yardstick::shared_cable) continue;
    if (row.site != Site::link && row.site != Site::motor) continue;
    INFO(label(row));
    check_row(row, rigid_drive({0.35, 6.5, 6.0, 0.03}));
  }
}

/// Energy of the springs and masses of paper_rig_low.
double energy(const Model& model, const SimulationResult& r, Eigen::Index row) {
  return 0.5 * 0.339 * r.qd(row, 0) * r.qd(row, 0) +
         0.5 * 0.0133 * r.thetad(row, 0) * r.thetad(row, 0) +
         model.transmission.energy(Eigen::VectorXd::Constant(1, r.q(row, 0)),
                                   Eigen::VectorXd::Constant(1, r.theta(row, 0)));
}

TEST_CASE("friction that is added never feeds a motion", "[simulate]") {
  for (const Effect& row : candidate_effects()) {
    const auto linear = row.parameters.first(row.n_linear());
    const bool is_friction = (row.torque || row.level) &&
                             std::all_of(linear.begin(), linear.end(),
                                         [](const ParameterInfo& p) { return p.lower == 0; });
    if (!is_friction) continue;
    INFO(label(row));
    Model plain = paper_rig_low();
    plain.joints[0].motor[3].parameters[0].value = 0;  // the offset is an input
    SimulationInput input = quiet_input(10000, kStep);
    input.theta0[0] = 0.03;
    input.qd0[0] = -1.5;
    const Values shape = middle_shape(row);
    const Values size =
        typical_size(row, shape, plain, input, simulate(plain, input, step_of(kStep)));
    const Model model = refined(plain, instance_of(row, size, shape));
    const SimulationResult motion = simulate(model, input, {});
    // Verlet's ripple (energy_test.cpp); a state stores at most its torque over its way, and gives
    // it back.
    const double stored = row.n_states > 0 ? 0.3 * 0.02 : 0;
    double before = energy(model, motion, 0);
    const double start = before;
    for (Eigen::Index i = 1; i < motion.q.rows(); ++i) {
      const double now = energy(model, motion, i);
      REQUIRE(now <= before * (1 + 6e-5) + stored);
      before = std::min(before, now);
    }
    CHECK(before < 0.1 * start);
    CHECK(energy(model, motion, 9999) <= energy(plain, simulate(plain, input, {}), 9999) + stored);
  }
}

TEST_CASE("refinements in blocks are the same as in one go", "[simulate]") {
  const SimulationInput input = lively_input(3000, 1e-3);
  for (const char* name : {"cable_hysteresis", "creep", "cable_damping", "slip"}) {
    const Effect& row = find_candidate(name, Site::transmission);
    const Values shape = middle_shape(row);
    Model model = paper_rig_low();
    model = refined(model, instance_of(row, Values(row.n_linear(), 1e-4), shape));
    const SimulationResult whole = simulate(model, input, {});
    Simulation simulation(model, input, {});
    for (const Eigen::Index begin : {0, 1700}) {
      const Eigen::Index n = begin == 0 ? 1700 : 1300;
      const Eigen::Index there = std::min<Eigen::Index>(n + 1, 3000 - begin);
      SimulationInput block = input;
      block.tau = input.tau.middleRows(begin, there);
      block.tau_load = input.tau_load.middleRows(begin, there);
      const SimulationResult part = simulation.run(block, n);
      CHECK((part.q == whole.q.middleRows(begin, n)).all());
      CHECK((part.theta == whole.theta.middleRows(begin, n)).all());
    }
  }
}

TEST_CASE("an event belongs to one log", "[simulate]") {
  const Effect& slip = find_candidate("slip", Site::transmission);
  const Effect& contact = find_candidate("contact", Site::link);
  SimulationInput input = lively_input(2000, 1e-3);
  const SimulationResult plain = simulate(paper_rig_low(), input, {});
  for (const Effect* row : {&slip, &contact}) {
    EffectInstance instance = instance_of(*row, {0.001}, middle_shape(*row));
    instance.event_log = 1;
    const Model model = refined(paper_rig_low(), instance);
    const auto unlike_plain = [&](std::size_t log, double t0, Eigen::Index begin, Eigen::Index n) {
      input.log_number = log;
      input.t0 = t0;
      const SimulationResult motion = simulate(model, input, {});
      return (motion.theta - plain.theta).middleRows(begin, n).abs().maxCoeff() > 0;
    };
    CHECK_FALSE(unlike_plain(0, 0, 0, 2000));  // not yet
    CHECK_FALSE(unlike_plain(1, 0, 0, 1001));  // not yet in its own log
    CHECK(unlike_plain(1, 0, 1002, 998));
    CHECK(unlike_plain(1, 0.9, 110, 100));                 // which may begin later
    CHECK(unlike_plain(2, 0, 0, 2000) == (row == &slip));  // a slip stays, a contact is over
  }
}

TEST_CASE("a drive in closed loop makes of a command what the refinement says", "[simulate]") {
  Model model = paper_rig_low();
  model.rig.controller = Controller{};
  model.rig.controller->kp = 800;
  model.rig.controller->kd = 6;
  model.rig.controller->limit = 250;
  SimulationInput input = quiet_input(2000, 1e-3);
  const Eigen::ArrayXd t = 1e-3 * Eigen::ArrayXd::LinSpaced(2000, 0, 1999);
  input.theta_ref = 0.2 * (6 * t).sin();
  SimulationOptions closed;
  closed.closed_loop = true;
  const Effect& saturation = find_candidate("saturation", Site::drive);
  const SimulationResult clipped =
      simulate(refined(model, instance_of(saturation, {}, {12})), input, closed);
  Model weak = model;
  weak.rig.controller->limit = 12;
  const SimulationResult expected = simulate(weak, input, closed);
  CHECK((clipped.theta == expected.theta).all());
  CHECK(clipped.tau.maxCoeff() > 12);  // the command
  CHECK(expected.tau.maxCoeff() == 12);

  const Effect& delay = find_candidate("torque_delay", Site::sensor);
  const SimulationResult late =
      simulate(refined(model, instance_of(delay, {0.003}, {})), input, closed);
  SimulationInput replay = input;
  for (Eigen::Index i = 0; i < 2000; ++i)
    replay.tau(i, 0) = late.tau(std::max<Eigen::Index>(0, i - 3), 0);
  const SimulationResult replayed = simulate(model, replay, {});
  CHECK((late.theta - replayed.theta).abs().maxCoeff() < 1e-9);  // rounding of the cubic, 2 s long
  CHECK((late.theta - simulate(model, input, closed).theta).abs().maxCoeff() > 1e-4);
}

/// A log of what `motion` did, with this torque and this q in it.
LogSurvey log_of(const SimulationInput& input, const SimulationResult& motion,
                 const Recording& logged) {
  truth::Log log;
  for (Eigen::Index i = 0; i < motion.q.rows(); ++i)
    log.t.push_back(static_cast<double>(i) * input.period);
  log.q.assign(logged.q.begin(), logged.q.end());
  log.theta.assign(motion.theta.col(0).begin(), motion.theta.col(0).end());
  log.tau.assign(logged.tau.begin(), logged.tau.end());
  log.tau_load.assign(input.tau_load.col(0).begin(), input.tau_load.col(0).end());
  return survey_of(log, default_rig());
}

TEST_CASE("what a sensor or drive does wrong is put right before a replay", "[simulate]") {
  const std::vector<std::pair<const char*, double>> values = {{"encoder_delay", 3e-3},
                                                              {"torque_delay", 3e-3},
                                                              {"saturation", 12},
                                                              {"drive_dead_band", 1.5}};
  std::size_t n_rows = 0;
  for (const Effect& row : candidate_effects()) n_rows += row.correct != nullptr;
  CHECK(n_rows == values.size());
  for (const auto& [name, value] : values) {
    INFO(name);
    const Site site = std::string(name).ends_with("delay") ? Site::sensor : Site::drive;
    const Effect& row = find_candidate(name, site);
    SimulationInput input = lively_input(4000, 1e-3);
    Recording truth;
    truth.period = input.period;
    truth.tau = input.tau.col(0);
    truth.q = Eigen::ArrayXd::Zero(4000);
    const Eigen::ArrayXd command = truth.tau;
    row.correct(&value, truth);
    input.tau.col(0) = truth.tau;
    const SimulationResult motion = simulate(paper_rig_low(), input, {});
    Recording logged = truth;
    logged.q = motion.q.col(0);
    const double undone = -value;
    if (row.step > 0) row.correct(&undone, logged);  // delays
    logged.tau = command;
    const std::vector<LogSurvey> logs = {log_of(input, motion, logged)};
    const Model model = refined(
        paper_rig_low(), instance_of(row, row.step > 0 ? Values{value} : Values{}, Values{value}));
    ReplayOptions options = in_mode(ReplayMode::torque);
    options.window = 0;
    const auto deflection = [&](const Model& of) {
      return gap_of(simulate_logs(of, logs, options).parts.at(0), "deflection").rms;
    };
    const double before = deflection(paper_rig_low()), after = deflection(model);
    CHECK(before > 1e-4);
    CHECK(after < 0.05 * before);  // what the start from measured positions costs
  }
}

TEST_CASE("what a cable remembers outlives the windows of a replay", "[simulate]") {
  const Effect& creep = find_candidate("creep", Site::transmission);
  const Model model = refined(paper_rig_low(), instance_of(creep, {2e-5}, {2.0, 0}));
  SimulationInput input = lively_input(6000, 1e-3);
  input.tau += 12;
  input.tau_load -= 12;
  const SimulationResult motion = simulate(model, input, {});
  Recording logged;
  logged.q = motion.q.col(0);
  logged.tau = input.tau.col(0);
  const std::vector<LogSurvey> logs = {log_of(input, motion, logged)};
  ReplayOptions options = in_mode(ReplayMode::torque);
  options.window = 0.5;
  const auto deflection = [&](const Model& of) {
    return gap_of(simulate_logs(of, logs, options).parts.at(0), "deflection").rms;
  };
  // A creep that began anew in every window would leave more than half of it out.
  CHECK(deflection(model) < 0.1 * deflection(paper_rig_low()));
}

}  // namespace
