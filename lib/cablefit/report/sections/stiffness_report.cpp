#include "cablefit/report/sections/stiffness_report.hpp"

#include <fmt/format.h>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

std::string fine(double value) { return significant(value == 0 ? 0 : value, kFineDigits); }

std::string numbers(const Eigen::VectorXd& values, double scale = 1) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + fine(scale * value);
  return text;
}

struct Units {
  std::string torque, stiffness, angle, elongation, tension, cable;

  explicit Units(const DesignResult& r)
      : torque(torque_unit(r.axes)),
        stiffness(unit_for(r.axes, "N m/rad")),
        angle(unit_for(r.axes, "mrad")),
        elongation(r.cable_space ? "mm" : unit_for(r.axes, "mrad")),
        tension(r.cable_space ? "N" : torque_unit(r.axes)),
        cable(r.cable_space ? "N/m" : unit_for(r.axes, "N m/rad")) {}
};

/// Torque of joint j by positions of joint k: four blocks, q first.
Table matrix_table(const PoseStiffness& pose, const Units& units) {
  Table table;
  table.title = fmt::format("Stiffness of the joints {} [{}]", pose.where, units.stiffness);
  table.columns = {{"", "d torque", "", true}};
  const Eigen::Index n = pose.joints.link_q.rows();
  const auto label = [n](const char* name, Eigen::Index k) {
    return n > 1 ? fmt::format("{}{}", name, k + 1) : std::string(name);
  };
  for (const char* by : {"q", "theta"})
    for (Eigen::Index k = 0; k < n; ++k) table.columns.push_back({"by", label(by, k), ""});
  const auto add = [&](const char* name, const Eigen::MatrixXd& q, const Eigen::MatrixXd& theta) {
    for (Eigen::Index j = 0; j < n; ++j) {
      std::vector<std::string> row = {label(name, j)};
      for (Eigen::Index k = 0; k < n; ++k) row.push_back(fine(q(j, k)));
      for (Eigen::Index k = 0; k < n; ++k) row.push_back(fine(theta(j, k)));
      table.rows.push_back(std::move(row));
    }
  };
  add("tau_l", pose.joints.link_q, pose.joints.link_theta);
  add("tau_m", pose.joints.motor_q, pose.joints.motor_theta);
  table.notes = {
      fmt::format("q = {} {}, theta = {} {}", numbers(pose.q, 1e3), units.angle,
                  numbers(pose.theta, 1e3), units.angle),
      fmt::format("eigenvalues: {} with the links blocked, {} with the motors blocked; {}",
                  numbers(pose.modes.motors_free), numbers(pose.modes.links_free),
                  pose.modes.passive ? "passive" : "NOT passive: the energy has no minimum here")};
  return table;
}

Table cable_table(const PoseStiffness& pose, const DesignResult& result, const Units& units) {
  Table table;
  table.title = fmt::format("Cables {}", pose.where);
  table.columns = {{"", "cable", "", true},
                   {"", "elongation", units.elongation},
                   {"", "tension", units.tension},
                   {"", "stiffness", units.cable}};
  for (Eigen::Index k = 0; k < pose.elongation.size(); ++k)
    table.rows.push_back({result.cables[static_cast<std::size_t>(k)],
                          fine(1e3 * pose.elongation(k)), fine(pose.tension(k)),
                          fine(pose.stiffness(k))});
  return table;
}

Table along_table(const StiffnessAlong& along, const Units& units) {
  Table table;
  table.title = "Stiffness along " + along.log;
  table.columns = {{"", "joint", "", true},
                   {"d tau_m/d theta", "least", units.stiffness},
                   {"d tau_m/d theta", "largest", units.stiffness}};
  for (Eigen::Index k = 0; k < along.least.size(); ++k)
    table.rows.push_back({std::to_string(k + 1), fine(along.least(k)), fine(along.largest(k))});
  const auto percent = [&](std::size_t n) {
    return 100 * static_cast<double>(n) /
           static_cast<double>(std::max<std::size_t>(1, along.n_samples));
  };
  table.notes = {
      fmt::format("eigenvalues of d tau_m/d theta: {} .. {} {}; all cables taut in {:.1f} "
                  "% of {} samples, passive in {:.1f} %",
                  fine(along.least_eigenvalue), fine(along.largest_eigenvalue), units.stiffness,
                  percent(along.n_closure), along.n_samples, percent(along.n_passive))};
  return table;
}

Table balance_table(const Balance& balance, const Units& units) {
  Table table;
  table.title = "Nearest preload in equilibrium (8c)";
  table.columns = {{"", "cable", "", true},
                   {"now", "l_o", units.elongation},
                   {"now", "tension", units.tension},
                   {"in equilibrium", "l_o", units.elongation},
                   {"in equilibrium", "tension", units.tension}};
  for (const BalancedCable& cable : balance.cables)
    table.rows.push_back({cable.name, fine(1e3 * cable.l_o), fine(cable.tension),
                          fine(1e3 * cable.balanced_l_o), fine(cable.balanced_tension)});
  table.notes = {fmt::format("now the preload alone makes {} {} on the link and {} {} on the motor",
                             numbers(balance.link), units.torque, numbers(balance.motor),
                             units.torque)};
  return table;
}

}  // namespace

void add_stiffness(const DesignResult& result, Document& document) {
  const Units units(result);
  for (const PoseStiffness& pose : result.stiffness) {
    add_table(document, matrix_table(pose, units));
    add_table(document, cable_table(pose, result, units));
  }
  if (result.along) add_table(document, along_table(*result.along, units));
  if (result.balance) add_table(document, balance_table(*result.balance, units));
}

}  // namespace cablefit
