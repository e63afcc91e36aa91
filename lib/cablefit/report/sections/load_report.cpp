#include "cablefit/report/sections/load_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/base/axes.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

constexpr int kLoadDigits = 4;
constexpr double kRounded = 1e-9;  // of a number: 0

std::string four(double value) {
  return significant(std::abs(value) < kRounded ? 0 : value, kLoadDigits);
}

struct LoadUnits {
  std::string torque, angle, elongation, tension;

  explicit LoadUnits(const DesignResult& r)
      : torque(torque_unit(r.axes)),
        angle(unit_for(r.axes, "mrad")),
        elongation(r.cable_space ? "mm" : unit_for(r.axes, "mrad")),
        tension(r.cable_space ? "N" : torque_unit(r.axes)) {}
};

std::string own_text(const HeldLoad& held) {
  return four(kMilli * held.l_o) + (held.is_own ? " own" : "");
}

std::string slack_cables(const HeldLoad& held, const DesignResult& result) {
  std::string names;
  for (Eigen::Index i = 0; i < held.tension.size(); ++i)
    if (!(held.elongation(i) > 0))
      names += (names.empty() ? "" : ", ") + result.cables[static_cast<std::size_t>(i)];
  return names.empty() ? kNoNumber : names;
}

std::string load_text(const HeldLoad& held) {
  std::string text;
  for (const double torque : held.load)
    text += (text.empty() ? "" : ":") + fmt::format("{:g}", torque);
  return text;
}

Table sag_table(const DesignResult& result, const LoadUnits& units) {
  const bool several = result.held.front().load.size() > 1;
  Table table;
  table.title = "Constant load on the links, motors held";
  table.columns = {{"", "l_o", units.elongation}, {"", "load", units.torque}};
  if (several) table.columns.push_back({"", "joint", "", true});
  for (const Column& column : {Column{"deflection theta - q", "", units.angle},
                               Column{"deflection theta - q", "none slack", units.angle},
                               Column{"", "by slack", "%"}, Column{"", "slack cables", "", true}})
    table.columns.push_back(column);
  for (const HeldLoad& held : result.held)
    for (Eigen::Index j = 0; j < held.load.size(); ++j) {
      std::vector<std::string> row = {own_text(held), load_text(held)};
      if (several) row.push_back(std::to_string(j + 1));
      row.insert(row.end(),
                 {four(kMilli * held.deflection(j)), four(kMilli * held.without_slack(j)),
                  significant(100 * held.slack_share(), 3), slack_cables(held, result)});
      table.rows.push_back(std::move(row));
    }
  table.notes = {
      "deflection from that without load, without friction; none slack: if a slack "
      "cable still acted, with its stiffness at l = 0; by slack: the rest"};
  return table;
}

Table loaded_cables(const DesignResult& result, const LoadUnits& units) {
  Table table;
  table.title = "Cables under a constant load";
  table.columns = {{"", "l_o", units.elongation},
                   {"", "load", units.torque},
                   {"", "cable", "", true},
                   {"", "elongation", units.elongation},
                   {"", "tension", units.tension}};
  for (const HeldLoad& held : result.held)
    for (Eigen::Index i = 0; i < held.tension.size(); ++i)
      table.rows.push_back({own_text(held), load_text(held),
                            result.cables[static_cast<std::size_t>(i)],
                            four(kMilli * held.elongation(i)), four(held.tension(i))});
  return table;
}

}  // namespace

void add_held_loads(const DesignResult& result, Document& document) {
  if (result.held.empty()) return;
  constexpr std::size_t kFewRows = 8;
  const LoadUnits units(result);
  add_table(document, sag_table(result, units));
  Table cables = loaded_cables(result, units);
  const bool few_rows = cables.rows.size() <= kFewRows;
  few_rows ? add_table(document, std::move(cables)) : add_detail(document, std::move(cables));
  for (const HeldLoad& held : result.held)
    for (Eigen::Index j = 0; j < held.load.size(); ++j)
      add_tidy_number(document.tidy, "l_o " + exact(held.l_o) + " load " + load_text(held),
                      "cables", "design", "deflection[" + std::to_string(j + 1) + "]",
                      unit_for(result.axes, "rad"), held.deflection(j));
}

}  // namespace cablefit
