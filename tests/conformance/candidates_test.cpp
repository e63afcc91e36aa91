// Every candidate row of the catalogue keeps the promises of effects.hpp.
#include "cablefit/model/effects.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "cablefit/base/units.hpp"
#include "tests/conformance/transmissions.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using Values = std::vector<double>;

constexpr LogScale kScale{.peak = 30, .travel = 0.4, .speed = 2.5, .deflection = 0.03};

std::string label(const Effect& row) {
  return std::string(row.name) + " of the " + std::string(to_string(row.site));
}

/// Every combination of the values of the grids.
std::vector<Values> shapes_of(const Effect& row) {
  std::vector<Values> all{{}};
  for (const ShapeGrid& grid : row.shape) {
    std::vector<Values> longer;
    for (const Values& values : all)
      for (int i = 0; i < grid.n_values; ++i) {
        longer.push_back(values);
        longer.back().push_back(grid.value(i, kScale));
      }
    all = longer;
  }
  return all;
}

/// Where nothing happens: 0 where that is allowed, and no torque beyond the peak.
Values neutral_parameters(const Effect& row) {
  Values values;
  for (std::size_t i = 0; i < row.parameters.size(); ++i) {
    const bool is_limit =
        i >= row.n_linear() && row.shape[i - row.n_linear()].unit == GridUnit::peak &&
        row.shape[i - row.n_linear()].high > 0.5;  // up to the peak, unlike a band at zero
    values.push_back(is_limit ? kScale.peak : std::max(0.0, row.parameters[i].lower));
  }
  return values;
}

/// The paper's rig at the low preload: Table 1.
Transmission paper_cables() {
  Transmission transmission = antagonist_pair(2);
  transmission.cables[0].coefficients = {1367.7, 37844.1};
  transmission.cables[1].coefficients = {1575.3, 29357.2};
  return transmission;
}

Transmission paper_spring() {
  Transmission transmission;
  transmission.theta_0 = Eigen::VectorXd::Constant(1, 0.001);
  transmission.linear_stiffness = Eigen::VectorXd::Constant(1, 1900);
  return transmission;
}

struct Torques {
  Values link, motor, level;
};

Torques act(const Effect& row, const JointState& state, double direction, const Values& shape,
            const Values& z) {
  const Values none(row.n_linear(), 0.0);
  Torques torques{none, none, none};
  if (row.torque)
    row.torque(state, shape.data(), z.data(), torques.link.data(), torques.motor.data());
  if (row.level) row.level(state, direction, shape.data(), z.data(), torques.level.data());
  return torques;
}

JointState random_state(std::mt19937& engine) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto random = [&](double size) { return size * uniform(engine); };
  JointState state;
  state.t = 10 + random(10);
  state.since_event = random(1);
  state.q = random(1);
  state.qd = random(2);
  state.qdd = random(50);
  state.theta = state.q + random(0.02);
  state.thetad = state.qd + random(0.5);
  state.thetadd = random(80);
  state.deflection_rate = state.thetad - state.qd;
  state.load = random(10);
  state.path_friction = random(5);
  set_elastic(paper_cables(), Eigen::VectorXd::Constant(1, state.q),
              Eigen::VectorXd::Constant(1, state.theta), 0, state);
  return state;
}

TEST_CASE("the catalogue has all that docs/reference/effects.md promises", "[conformance]") {
  using Row = std::tuple<std::string, std::string, std::string>;
  std::set<Row> expected{{"constant_torque", "link", "constant"},
                         {"asymmetric_coulomb", "link", "constant"},
                         {"asymmetric_coulomb", "motor", "constant"},
                         {"gravity_imbalance", "link", ""},
                         {"path_friction", "link", ""},
                         {"load_friction", "motor", ""},
                         {"cogging", "motor", ""},
                         {"drive_efficiency", "motor", ""},
                         {"dead_zone", "transmission", "l_o"},
                         {"preload", "transmission", "l_o"},
                         {"torque_gain", "drive", "scale"},
                         {"load_scale", "link", "scale"},
                         {"saturation", "drive", ""},
                         {"drive_dead_band", "drive", ""},
                         {"slip", "transmission", ""},
                         {"contact", "link", ""},
                         {"payload_change", "link", ""}};
  for (const char* name : {"asymmetric_viscous", "stribeck", "quadratic_drag", "nonlinear_viscous",
                           "position_friction", "tension_friction", "presliding", "friction_drift"})
    for (const char* side : {"link", "motor"}) expected.insert({name, side, ""});
  for (const char* name : {"cable_damping", "cable_hysteresis", "stiffness_order",
                           "stiffness_asymmetry", "pulley_eccentricity", "creep"})
    expected.insert({name, "transmission", ""});
  for (const char* name :
       {"encoder_scale", "encoder_offset", "encoder_delay", "torque_delay", "offset_drift"})
    expected.insert({name, "sensor", ""});
  std::set<Row> found;
  for (const Effect& row : candidate_effects())
    found.insert(
        {std::string(row.name), std::string(to_string(row.site)), std::string(row.alias_class)});
  CHECK(candidate_effects().size() == found.size());  // none is there twice
  for (const Row& row : expected) {
    INFO(std::get<0>(row) << " (" << std::get<1>(row) << "), class '" << std::get<2>(row) << "'");
    CHECK(found.count(row) == 1);
  }
}

TEST_CASE("a candidate is found by name and side", "[conformance]") {
  for (const Effect& row : candidate_effects()) CHECK(&find_candidate(row.name, row.site) == &row);
  CHECK(test::message_of([] { (void)find_candidate("cogging", Site::link); }) ==
        "unknown effect 'cogging' of the link; there is one of: motor");
  CHECK(test::message_of([] { (void)find_candidate("stribek", Site::motor); }) ==
        "unknown effect 'stribek' of the motor; did you mean 'stribeck'?");
}

TEST_CASE("a candidate is documented", "[conformance]") {
  for (const Effect& row : candidate_effects()) {
    INFO(label(row));
    for (const std::string_view text : {row.equation, row.signature, row.experiment, row.source})
      CHECK_FALSE(text.empty());
    std::set<std::string_view> names;
    for (const ParameterInfo& info : row.parameters) {
      INFO(info.name);
      CHECK(names.insert(info.name).second);
      CHECK_FALSE(info.symbol.empty());
      CHECK_FALSE(info.meaning.empty());
      CHECK_NOTHROW(parse_unit(info.unit));
      CHECK_NOTHROW(parse_unit(unit_for(Axes::linear, info.unit)));
      CHECK(info.lower < info.upper);
    }
    REQUIRE(row.shape.size() <= row.parameters.size());
    CHECK(row.n_linear() >= static_cast<std::size_t>(2 * row.n_harmonics));
  }
}

TEST_CASE("a grid of a candidate rises within the bounds of its parameter", "[conformance]") {
  for (const Effect& row : candidate_effects())
    for (std::size_t i = 0; i < row.shape.size(); ++i) {
      const ShapeGrid& grid = row.shape[i];
      const ParameterInfo& info = row.parameters[row.n_linear() + i];
      INFO(label(row) << ", " << info.name);
      REQUIRE(grid.n_values >= 2);
      CHECK((grid.low > 0 || !grid.is_geometric));
      CHECK(grid.value(0, kScale) == Approx(grid.lowest(kScale)));
      CHECK(grid.value(grid.n_values - 1, kScale) == Approx(grid.grid_end(kScale)));
      CHECK(grid.grid_end(kScale) <= grid.highest(kScale));
      CHECK(info.lower <= grid.lowest(kScale));
      CHECK(grid.highest(kScale) <= info.upper);
      for (int k = 1; k < grid.n_values; ++k)
        CHECK(grid.value(k, kScale) > grid.value(k - 1, kScale));
    }
  const ShapeGrid even{.low = 1, .high = 3, .n_values = 3, .is_geometric = false};
  CHECK(even.value(1, kScale) == 2);
  const ShapeGrid peaks{.low = 0.25, .high = 1, .n_values = 3, .unit = GridUnit::peak};
  CHECK(peaks.value(1, {.peak = 10}) == Approx(5));
  const ShapeGrid orders{
      .low = 2, .high = 4, .n_values = 3, .is_geometric = false, .unit = GridUnit::per_travel};
  CHECK(orders.value(1, {.travel = 0.5}) == Approx(6));
}

TEST_CASE("a candidate is of one kind", "[conformance]") {
  for (const Effect& row : candidate_effects()) {
    INFO(label(row));
    const bool acts = row.torque || row.level;
    CHECK(int(acts) + int(row.correct != nullptr) + int(row.change != nullptr) == 1);
    CHECK((row.n_states > 0) == (row.advance != nullptr));
    if (row.n_states > 0) CHECK(acts);
    if (row.level) CHECK((row.site == Site::link || row.site == Site::motor));
    CHECK((row.step > 0) == (row.correct != nullptr && row.n_linear() == 1));
    if (acts) CHECK(row.n_linear() > 0);
    if (row.change) CHECK(row.n_linear() == 0);
  }
}

TEST_CASE("a candidate acts where it says", "[conformance]") {
  std::mt19937 engine(3);
  for (const Effect& row : candidate_effects()) {
    if (!row.torque && !row.level) continue;
    INFO(label(row));
    bool on_link = false, on_motor = false;
    for (const Values& shape : shapes_of(row))
      for (int k = 0; k < 20; ++k) {
        const JointState state = random_state(engine);
        const Torques torques =
            act(row, state, state.qd > 0 ? 1 : -1, shape, Values(row.n_states, 0.4));
        for (std::size_t i = 0; i < row.n_linear(); ++i) {
          REQUIRE(std::isfinite(torques.link[i] + torques.motor[i] + torques.level[i]));
          on_link =
              on_link || torques.link[i] != 0 || (row.site == Site::link && torques.level[i] != 0);
          on_motor = on_motor || torques.motor[i] != 0 ||
                     (row.site == Site::motor && torques.level[i] != 0);
          if (row.site == Site::transmission) CHECK(torques.link[i] == -torques.motor[i]);
        }
      }
    if (row.site == Site::link) CHECK((on_link && !on_motor));
    if (row.site == Site::motor || row.site == Site::drive) CHECK((on_motor && !on_link));
    if (row.site == Site::transmission) CHECK((on_motor && on_link));
  }
}

TEST_CASE("a candidate with a date does nothing before it", "[conformance]") {
  std::mt19937 engine(4);
  for (const Effect& row : candidate_effects()) {
    if (!row.is_event) continue;
    INFO(label(row));
    bool acts = false;
    for (const Values& shape : shapes_of(row))
      for (int k = 0; k < 20; ++k) {
        JointState state = random_state(engine);
        for (const double since : {-1e300, -0.01, 0.05}) {
          state.since_event = since;
          const Torques torques = act(row, state, 1, shape, {});
          for (const Values* values : {&torques.link, &torques.motor, &torques.level})
            for (const double value : *values) {
              if (since < 0) CHECK(value == 0);
              acts = acts || value != 0;
            }
        }
      }
    CHECK(acts);
  }
}

/// What the row takes from a drive that moves periodically, J over one period, all parameters 1,
/// beside as much Coulomb friction as it takes away. Its states have settled before.
double work_over_cycle(const Effect& row, const Transmission& transmission, const Values& shape) {
  constexpr int kSteps = 20000, kSettle = 3;
  const double h = 1.0 / kSteps, w = 2 * std::numbers::pi;
  Values z(row.n_states, 0.0);
  double work = 0;
  for (int i = 0; i < (kSettle + 1) * kSteps; ++i) {
    JointState state;
    state.t = (i + 0.5) * h;
    const double x = w * state.t;
    state.q = 0.3 * std::sin(x) + 0.05 * std::sin(3 * x + 1);
    state.qd = w * (0.3 * std::cos(x) + 0.15 * std::cos(3 * x + 1));
    state.deflection_rate = w * (0.012 * std::cos(2 * x) + 0.012 * std::cos(4 * x + 2));
    state.theta = state.q + 0.006 * std::sin(2 * x) + 0.003 * std::sin(4 * x + 2);
    state.thetad = state.qd + state.deflection_rate;
    set_elastic(transmission, Eigen::VectorXd::Constant(1, state.q),
                Eigen::VectorXd::Constant(1, state.theta), 0, state);
    state.load = 12;
    state.path_friction = state.qd > 0 ? state.tension : -state.tension;
    if (row.advance) row.advance(state, shape.data(), 0.5 * h, z.data());
    const double v = row.site == Site::link ? state.qd : state.thetad;
    const Torques torques = act(row, state, v > 0 ? 1 : -1, shape, z);
    for (std::size_t k = 0; k < row.n_linear() && i >= kSettle * kSteps; ++k) {
      const double dry = torques.level[k] + std::max(0.0, -torques.level[k]);
      work +=
          h * (torques.link[k] * state.qd + torques.motor[k] * state.thetad + dry * std::abs(v));
    }
    if (row.advance) row.advance(state, shape.data(), 0.5 * h, z.data());
  }
  return work;
}

TEST_CASE("what cannot be negative takes energy over every cycle", "[conformance]") {
  int n_rows = 0;
  for (const Effect& row : candidate_effects()) {
    if (!row.torque && !row.level) continue;
    const auto linear = row.parameters.first(row.n_linear());
    if (std::any_of(linear.begin(), linear.end(),
                    [](const ParameterInfo& info) { return info.lower < 0; }))
      continue;
    ++n_rows;
    INFO(label(row));
    for (const Values& shape : shapes_of(row))
      for (const Transmission& transmission : {paper_cables(), paper_spring()})
        CHECK(work_over_cycle(row, transmission, shape) > 0);
  }
  // stribeck, quadratic_drag, nonlinear_viscous, tension_friction, presliding on two sides;
  // path_friction, load_friction, drive_efficiency, cable_damping, cable_hysteresis, creep.
  CHECK(n_rows >= 16);
}

TEST_CASE("states are bounded and do not depend on the step", "[conformance]") {
  std::mt19937 engine(5);
  for (const Effect& row : candidate_effects()) {
    if (!row.advance) continue;
    INFO(label(row));
    for (const Values& shape : shapes_of(row))
      for (int k = 0; k < 20; ++k) {
        const JointState state = random_state(engine);
        const double bound = std::max(1.0, std::abs(state.tau_elas));
        for (const double h : {1e-4, 1e-3, 0.1, 1e3}) {
          Values one(row.n_states, 0.3), many = one;
          row.advance(state, shape.data(), h, one.data());
          for (int i = 0; i < 10; ++i) row.advance(state, shape.data(), h / 10, many.data());
          for (std::size_t i = 0; i < row.n_states; ++i) {
            // The same exponential, by ten factors of rounding each.
            CHECK(one[i] == Approx(many[i]).epsilon(0).margin(1e-14 * bound));
            CHECK(std::abs(one[i]) <= bound);
          }
          CHECK(one != Values(row.n_states, 0.3));
        }
        Values still(row.n_states, 0.3);
        row.advance(state, shape.data(), 0, still.data());
        CHECK(still == Values(row.n_states, 0.3));
      }
  }
}

Torques per_unit(std::string_view name, Site site, const JointState& state, const Values& z = {}) {
  return act(find_candidate(name, site), state, 1, {1.0, 1.0}, z);
}

TEST_CASE("what moves the deflection changes the cables' torque by as much", "[conformance]") {
  const double q = 0.3, theta = 0.31, a = 1e-6, c = 5;
  const Transmission cables = paper_cables();
  const auto tau_elas = [&](double more) {
    Eigen::VectorXd link, motor;
    cables.torques(Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, theta + more),
                   link, motor);
    return motor[0];
  };
  JointState state;
  state.q = q;
  state.theta = theta;
  set_elastic(cables, Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, theta), 0,
              state);
  // Deflection per unit of the first parameter.
  const std::vector<std::tuple<const char*, Site, double>> rows = {
      {"encoder_offset", Site::sensor, 1},
      {"encoder_scale", Site::sensor, theta},
      {"slip", Site::transmission, 1},
      {"pulley_eccentricity", Site::transmission, std::sin(q)},
      {"creep", Site::transmission, -c}};
  for (const auto& [name, site, deflection] : rows) {
    INFO(name);
    const Torques torques = per_unit(name, site, state, {c});
    CHECK(a * torques.motor[0] ==
          Approx(tau_elas(deflection * a) - tau_elas(0)).epsilon(1e-3));  // a tau''/tau' = 4e-4
    CHECK(torques.link[0] == -torques.motor[0]);
  }
}

TEST_CASE("scales are those that make a logged torque the true one", "[conformance]") {
  // At rest the motor holds tau_elas and the load holds -tau_elas; with the row the model gives
  // what was logged, true = (1 + a) logged.
  const double a = 1e-5;
  JointState state;
  state.tau_elas = 20;
  const double tau = state.tau_elas / (1 + a), load = -state.tau_elas / (1 + a);
  CHECK(state.tau_elas + a * per_unit("torque_gain", Site::drive, state).motor[0] ==
        Approx(tau).epsilon(2 * a * a));
  CHECK(-state.tau_elas + a * per_unit("load_scale", Site::link, state).link[0] ==
        Approx(load).epsilon(2 * a * a));
}

TEST_CASE("a drive loses while it drives, and a contact pushes", "[conformance]") {
  const Effect& efficiency = find_candidate("drive_efficiency", Site::motor);
  JointState state;
  for (const double tau_elas : {-7.0, 7.0})
    for (const double direction : {-1.0, 1.0}) {
      state.tau_elas = tau_elas;
      CHECK(act(efficiency, state, direction, {}, {}).level[0] ==
            (tau_elas * direction > 0 ? 7 : 0));
    }
  state.since_event = 0.5;
  CHECK(per_unit("contact", Site::link, state).link[0] == Approx(-1));
  state.since_event = 0.25;
  CHECK(per_unit("contact", Site::link, state).link[0] == Approx(-0.5));
}

Recording sines() {
  Recording recording;
  recording.period = 1e-3;
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(500, 0, 0.499);
  recording.q = (20 * t).sin();
  recording.theta = (20 * t + 0.01).sin();
  recording.tau = kScale.peak * (15 * t).sin();
  recording.tau_load = 3 * (5 * t).cos();
  return recording;
}

bool same(const Recording& a, const Recording& b) {
  return (a.q == b.q).all() && (a.theta == b.theta).all() && (a.tau == b.tau).all() &&
         (a.tau_load == b.tau_load).all();
}

TEST_CASE("a correction by nothing changes nothing", "[conformance]") {
  for (const Effect& row : candidate_effects()) {
    if (!row.correct) continue;
    INFO(label(row));
    Recording recording = sines();
    row.correct(neutral_parameters(row).data(), recording);
    CHECK(same(recording, sines()));
    Values moved = neutral_parameters(row);
    moved[0] = row.step > 0 ? row.step : 0.5 * row.shape[0].highest(kScale);
    row.correct(moved.data(), recording);
    CHECK_FALSE(same(recording, sines()));
  }
}

TEST_CASE("a delay is undone", "[conformance]") {
  // Lagrange's cubic is off by at most 3/128 (w h)^4 of the amplitude: 2.4e-8 at w h = 0.03.
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(500, 0, 0.499);
  for (const double d : {1e-4, 5e-4, 1e-3, 3.3e-3, -2.4e-3}) {
    Recording recording;
    recording.period = 1e-3;
    recording.q = (30 * (t - d)).sin();
    recording.tau = (30 * t).sin();
    find_candidate("encoder_delay", Site::sensor).correct(&d, recording);
    find_candidate("torque_delay", Site::sensor).correct(&d, recording);
    const Eigen::ArrayXd q_off = recording.q - (30 * t).sin();
    const Eigen::ArrayXd tau_off = recording.tau - (30 * (t - d)).sin();
    CHECK(q_off.segment(10, 480).abs().maxCoeff() < 2.5e-8);
    CHECK(tau_off.segment(10, 480).abs().maxCoeff() < 2.5e-8);
  }
}

TEST_CASE("a drive's limits act on large and on small torques", "[conformance]") {
  Recording recording;
  recording.tau.resize(5);
  recording.tau << -20, -2, 0.5, 3, 30;
  Recording clipped = recording, banded = recording;
  const double limit = 10, band = 1;
  find_candidate("saturation", Site::drive).correct(&limit, clipped);
  find_candidate("drive_dead_band", Site::drive).correct(&band, banded);
  CHECK(Values(clipped.tau.begin(), clipped.tau.end()) == Values{-10, -2, 0.5, 3, 10});
  CHECK(Values(banded.tau.begin(), banded.tau.end()) == Values{-19, -1, 0, 2, 29});
}

double motor_torque(const Transmission& transmission, double q, double theta) {
  Eigen::VectorXd link, motor;
  transmission.torques(Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, theta), link,
                       motor);
  return motor[0];
}

TEST_CASE("another transmission with nothing more has the same torque", "[conformance]") {
  for (const Effect& row : candidate_effects()) {
    if (!row.change) continue;
    INFO(label(row));
    Values shape = neutral_parameters(row);
    int n_changed = 0;
    for (const Transmission& before : {paper_cables(), paper_spring()}) {
      const auto after = row.change(before, shape.data());
      if (!after) continue;
      ++n_changed;
      for (double phi = -0.02; phi < 0.02; phi += 0.0013)
        CHECK(motor_torque(*after, 0.1, 0.1 + phi) ==
              Approx(motor_torque(before, 0.1, 0.1 + phi)).epsilon(1e-12).margin(1e-10));
    }
    CHECK(n_changed > 0);
  }
}

TEST_CASE("a dead zone is flat and preload is stiff near zero", "[conformance]") {
  const Effect& dead_zone = find_candidate("dead_zone", Site::transmission);
  const Effect& preload = find_candidate("preload", Site::transmission);
  const double size = 0.002;
  for (const Transmission& before : {paper_cables(), paper_spring()}) {
    const double zero = before.encoder_zero()[0];
    const Transmission slack = dead_zone.change(before, &size).value();
    CHECK(motor_torque(slack, 0, zero + 0.0019) == 0);
    CHECK(motor_torque(slack, 0, zero + 0.0030) == Approx(motor_torque(before, 0, zero + 0.0010)));
    const Transmission taut = preload.change(before, &size).value();
    CHECK(taut.cables[0].initial_elongation == size);
    CHECK(taut.cables[1].initial_elongation > 0);
    CHECK(motor_torque(taut, 0, zero) == Approx(0).margin(1e-9));
    const double push = 1e-4;
    CHECK(motor_torque(taut, 0, zero + push) > 1.9 * motor_torque(before, 0, zero + push));
    // They are there already.
    CHECK_FALSE(dead_zone.change(slack, &size));
    CHECK_FALSE(preload.change(taut, &size));
  }
}

TEST_CASE("in cable space elongations follow the motor's pulley", "[conformance]") {
  Transmission rope = test::transmission_of(test::routings().front(), find_cable_law("polynomial"));
  for (Cable& cable : rope.cables) cable.initial_elongation = 0;
  const double angle = 0.01;  // rad; its pulleys have 30 mm
  const auto slack = find_candidate("dead_zone", Site::transmission).change(rope, &angle);
  const auto taut = find_candidate("preload", Site::transmission).change(rope, &angle);
  REQUIRE(slack);
  REQUIRE(taut);
  CHECK(slack->cables[1].initial_elongation == Approx(-3e-4));
  CHECK(taut->cables[0].initial_elongation == Approx(3e-4));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(1);
  Eigen::VectorXd link, motor;
  taut->torques(zero, zero, link, motor);
  CHECK(motor[0] == Approx(0).margin(1e-9));
}

TEST_CASE("no other transmission where it makes no sense", "[conformance]") {
  const double one = 1;
  const Effect& order = find_candidate("stiffness_order", Site::transmission);
  const Effect& asymmetry = find_candidate("stiffness_asymmetry", Site::transmission);
  CHECK(order.change(paper_spring(), &one)->cables[1].order ==
        2);  // a pair that is no longer linear
  CHECK_FALSE(asymmetry.change(paper_cables(), nullptr));
  CHECK(order.change(paper_cables(), &one)->cables[1].order == 3);
  Transmission highest = paper_cables();
  for (Cable& cable : highest.cables) {
    cable.order = kMaxCableOrder;
    cable.coefficients.resize(kMaxCableOrder);
  }
  CHECK_FALSE(order.change(highest, &one));
  const double l_o = 0.001;
  const Transmission finger =
      test::transmission_of(test::routings().back(), find_cable_law("polynomial"));
  CHECK_FALSE(find_candidate("preload", Site::transmission).change(finger, &l_o));
}

TEST_CASE("what a state says of the transmission is the transmission's", "[conformance]") {
  for (const test::Routing& routing : test::routings())
    for (const CableLaw& law : cable_laws()) {
      INFO(routing.name << ", " << law.name);
      Transmission transmission = test::transmission_of(routing, law);
      const Eigen::Index n = transmission.n_joints;
      transmission.theta_0 = Eigen::VectorXd::Constant(n, 0.02);
      const Eigen::VectorXd q = Eigen::VectorXd::Constant(n, 0.1);
      const Eigen::VectorXd theta = Eigen::VectorXd::LinSpaced(n, 0.17, 0.19);
      Eigen::VectorXd link, motor, unused;
      transmission.torques(q, theta, link, motor);
      for (Eigen::Index k = 0; k < n; ++k) {
        JointState state;
        set_elastic(transmission, q, theta, static_cast<int>(k), state);
        CHECK(state.tau_elas == Approx(motor[k]).margin(1e-12));
        CHECK(state.deflection == Approx(theta[k] - 0.02 - q[k]));
        CHECK(state.tension >= std::abs(state.tau_elas) * (1 - 1e-12));
        Eigen::VectorXd up, down, more = theta, less = theta;
        more[k] += 1e-6;
        less[k] -= 1e-6;
        transmission.torques(q, more, unused, up);
        transmission.torques(q, less, unused, down);
        CHECK(state.stiffness == Approx((up[k] - down[k]) / 2e-6).epsilon(1e-5).margin(1e-4));
      }
    }
}

}  // namespace
