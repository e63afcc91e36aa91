// Every row of the table acts where it says, and the table covers the list of
// docs/reference/effects.md.
#include "effects/effects.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "floor.hpp"

using namespace hidden;

namespace {

/// The closed list of docs/reference/effects.md, with the sides each name has.
const std::map<std::string, std::set<std::string>>& contract() {
  static const std::set<std::string> both{"link", "motor"}, cable{"transmission"}, sensor{"sensor"};
  static const std::map<std::string, std::set<std::string>> names{{"constant_torque", {"link"}},
                                                                  {"asymmetric_coulomb", both},
                                                                  {"gravity_imbalance", {"link"}},
                                                                  {"asymmetric_viscous", both},
                                                                  {"stribeck", both},
                                                                  {"quadratic_drag", both},
                                                                  {"nonlinear_viscous", both},
                                                                  {"position_friction", both},
                                                                  {"tension_friction", both},
                                                                  {"presliding", both},
                                                                  {"friction_drift", both},
                                                                  {"cogging", {"motor"}},
                                                                  {"drive_efficiency", {"motor"}},
                                                                  {"cable_damping", cable},
                                                                  {"cable_hysteresis", cable},
                                                                  {"stiffness_order", cable},
                                                                  {"stiffness_asymmetry", cable},
                                                                  {"pulley_eccentricity", cable},
                                                                  {"creep", cable},
                                                                  {"dead_zone", cable},
                                                                  {"preload", cable},
                                                                  {"encoder_scale", sensor},
                                                                  {"encoder_offset", sensor},
                                                                  {"encoder_delay", sensor},
                                                                  {"torque_delay", sensor},
                                                                  {"offset_drift", sensor},
                                                                  {"torque_gain", {"drive"}},
                                                                  {"load_scale", {"link"}},
                                                                  {"saturation", {"drive"}},
                                                                  {"drive_dead_band", {"drive"}},
                                                                  {"slip", cable},
                                                                  {"contact", {"link"}},
                                                                  {"payload_change", {"link"}}};
  return names;
}

const Bench& paper() {
  static const Bench bench;
  return bench;
}

std::vector<Run> two_runs() {
  std::vector<Run> runs(2);
  for (std::size_t i = 0; i < 2; ++i) {
    runs[i].name = i == 0 ? "slow" : "fast";
    runs[i].number = static_cast<int>(i) + 1;
    runs[i].load = i == 0 ? 30 : -40;
    runs[i].reference = i == 0 ? multisine({6, 0.05, 0.6, 1, 0.5, 0, 3}, paper())
                               : multisine({6, 0.05, 2, 0.3, 0.6, 6, 4}, paper());
  }
  return runs;
}

Equations exact_rows(const Row* row) {
  std::vector<Signals> signals;
  for (const Run& run : two_runs()) {
    std::vector<Hooks> hooks;
    Draw draw;
    draw.event_run = 2;
    draw.event_time = 3;
    if (row != nullptr) {
      draw.size = row->size;
      draw.u = 0.3;
      hooks.push_back(row->make(draw, run, paper()).hooks);
    }
    signals.push_back(simulate(paper(), hooks, run).exact);
  }
  return equations(signals);
}

/// Correlation of what the true base leaves in the link's rows with what it leaves in the motor's.
double correlation(const Equations& rows) {
  const Base base = base_of(paper().rig);
  std::map<Eigen::Index, double> link;
  const Rows &l = rows[kLinkRows], &m = rows[kMotorRows];
  const Eigen::VectorXd in_link = l.y - l.W * base, in_motor = m.y - m.W * base;
  for (std::size_t i = 0; i < l.sample.size(); ++i)
    link[l.sample[i]] = in_link[static_cast<Eigen::Index>(i)];
  double ll = 0, mm = 0, lm = 0;
  for (std::size_t i = 0; i < m.sample.size(); ++i) {
    const auto found = link.find(m.sample[i]);
    if (found == link.end()) continue;
    const double x = found->second, y = in_motor[static_cast<Eigen::Index>(i)];
    ll += x * x;
    mm += y * y;
    lm += x * y;
  }
  return lm / std::sqrt(ll * mm);
}

}  // namespace

TEST_CASE("every name and side of the reference is there, and no other") {
  std::map<std::string, std::set<std::string>> found;
  for (const Row& row : all_rows())
    if (row.form == Form::matched) found[std::string(row.name)].emplace(row.side);
  CHECK(found == contract());
  std::size_t others = 0, matched = 0;
  std::set<std::string> ids;
  for (const Row& row : all_rows()) {
    CHECK(ids.insert(id_of(row)).second);
    if (row.form == Form::outside) {
      CHECK(contract().count(std::string(row.name)) == 0);
      continue;
    }
    CHECK(contract().at(std::string(row.name)).count(std::string(row.side)) == 1);
    CHECK(row.variant.empty() == (row.form == Form::matched));
    ++(row.form == Form::other ? others : matched);
  }
  CHECK(3 * others >= others + matched - 2);  // a third, two rows being in the base
}

TEST_CASE("an effect shows in the rows of its side and in no others") {
  const Base base = base_of(paper().rig);
  static const Equations copy = exact_rows(nullptr);
  const PerEquation none = mean_square(copy, base);
  for (const Row& row : all_rows()) {
    DYNAMIC_SECTION(id_of(row)) {
      const Equations rows = exact_rows(&row);
      const PerEquation with = mean_square(rows, base);
      const double link = with[kLinkRows] - none[kLinkRows];
      const double motor = with[kMotorRows] - none[kMotorRows];
      // Leftovers of filtering (`none`) vary with the motion, which the effect changes as well.
      const double link_limit = std::max(2 * none[kLinkRows], 0.02 * motor);
      const double motor_limit = std::max(2 * none[kMotorRows], 0.02 * link);
      INFO("link " << link << " of " << none[kLinkRows] << ", motor " << motor << " of "
                   << none[kMotorRows]);
      if (row.shows == Shows::nothing) {
        const PerEquation sd = PerEquation::Constant(0.05);
        CHECK(std::abs(rho_of(rows, copy, sd).all - 1) < 0.05);
        continue;
      }
      CHECK((link > link_limit) == (row.shows != Shows::motor));
      CHECK((motor > motor_limit) == (row.shows != Shows::link));
      if (row.shows == Shows::opposite) CHECK(correlation(rows) < -0.9);
    }
  }
}

TEST_CASE("an effect that is not there is named with those that are") {
  CHECK(&row_of("cogging.motor.two_harmonics") != &row_of("cogging.motor"));
  CHECK_THROWS_WITH(row_of("coging.motor"),
                    Catch::Contains("no effect 'coging.motor'; there are:") &&
                        Catch::Contains(" cogging.motor "));
}
