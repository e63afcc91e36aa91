#include "cablefit/report/sections/friction_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

constexpr int kShort = 3;
constexpr double kPercent = 100;

std::string short_text(double value) { return significant(value, kShort); }

/// Words of the units of one result.
struct FrictionWords {
  std::string torque, stiffness, elongation;
  bool several_joints;

  explicit FrictionWords(const DesignResult& r)
      : torque(torque_unit(r.axes)),
        stiffness(unit_for(r.axes, "N m/rad")),
        elongation(r.cable_space ? "mm" : unit_for(r.axes, "mrad")),
        several_joints(!r.points.empty() && r.points.front().joints.size() > 1) {}

  std::string length(double l_o) const {
    return fmt::format("{} {}", significant(1e3 * l_o, kShort), elongation);
  }
};

const std::string& joint_name(const DesignResult& result, int joint) {
  return result.points.front().joints[static_cast<std::size_t>(joint)].name;
}

std::string interval_text(double low, double high, double sd) {
  return std::isfinite(low) ? value_text(low, sd) + " .. " + value_text(high, sd)
                            : std::string(kNoNumber);
}

Table fitted_table(const DesignResult& result, const FrictionWords& words) {
  Table table;
  table.title = "Fitted preloads";
  table.columns = {{"", "preload", "", true},
                   {"", "l_o", words.elongation},
                   {"stiffness", "no load", words.stiffness},
                   {"", "all taut up to", words.torque},
                   {"linear spring", "error", words.torque},
                   {"linear spring", "collision", words.torque},
                   {"", "dry friction", words.torque},
                   {"", "efficiency", "%"}};
  if (words.several_joints)
    table.columns.insert(table.columns.begin() + 1, {"", "joint", "", true});
  for (const DesignPoint& point : result.fitted)
    for (const DesignJoint& joint : point.joints) {
      const ModelCost& linear = joint.model("linear");
      std::vector<std::string> row = {
          point.preload,
          short_text(1e3 * point.l_o),
          value_with_sd(joint.stiffness_zero, joint.sd ? joint.sd->stiffness_zero : kNotKnown),
          short_text(joint.closure_torque),
          short_text(linear.max_error),
          linear.collision ? short_text(linear.collision->torque) : kNoNumber,
          joint.friction ? value_with_sd(joint.friction->at_rest, joint.friction->sd) : kNoNumber,
          joint.friction ? short_text(kPercent * joint.friction->efficiency_driving) : kNoNumber};
      if (words.several_joints) row.insert(row.begin() + 1, joint.name);
      table.rows.push_back(std::move(row));
    }
  table.notes = {
      "each with its own cables; dry friction: f_s + f_sm and what was added to them; "
      "efficiency: of slow motion against the torque"};
  return table;
}

std::string law_of(const FrictionCurve& curve) {
  if (!curve.line) return curve.points.size() == 1 ? "one preload" : "preloads alike";
  return curve.by_tension ? "tension" : "l_o";
}

Table line_table(const DesignResult& result, const FrictionWords& words) {
  Table table;
  table.title = "Friction against the preload: lines through the fits";
  table.columns = {{"", "friction", "", true},  {"", "unit", "", true},  {"", "fits", ""},
                   {"", "line over", "", true}, {"c0 + c1 x", "c0", ""}, {"c0 + c1 x", "c1", ""},
                   {"", "misfit sd", ""},       {"", "p-value", ""}};
  if (words.several_joints) table.columns.insert(table.columns.begin(), {"", "joint", "", true});
  for (const FrictionCurve& curve : result.friction) {
    std::vector<std::string> row = {curve.name, curve.unit, std::to_string(curve.points.size()),
                                    law_of(curve)};
    if (curve.line) {
      const PreloadLine& line = *curve.line;
      row.insert(row.end(), {value_with_sd(line.intercept(), line.intercept_sd()),
                             value_with_sd(line.slope, line.slope_sd()),
                             curve.points.size() > 2 ? short_text(line.misfit) : kNoNumber,
                             curve.points.size() > 2 ? short_text(line.p_value) : kNoNumber});
    } else {
      row.insert(row.end(), 4, kNoNumber);
    }
    if (words.several_joints) row.insert(row.begin(), joint_name(result, curve.joint));
    table.rows.push_back(std::move(row));
  }
  table.notes = {fmt::format(
      "tension: sum of the tensions at rest at the motor's pulleys, {}; l_o: of cable "
      "{}, {}; used up to {:g} % of the fitted range beyond it; two fits do not show "
      "whether friction follows a line",
      words.torque, result.cables.front(), result.cable_space ? "m" : "rad", kPercent * kBeyond)};
  return table;
}

/// Each part with its sd at every design of the sweep where it is known.
Table part_table(const DesignResult& result, const FrictionWords& words) {
  Table table;
  table.title = "Friction at each preload";
  table.columns = {{"", "l_o", words.elongation},
                   {"", "friction", "", true},
                   {"", "unit", "", true},
                   {"", "value", ""},
                   {"", "sd", ""},
                   {"", "95 % interval", ""}};
  if (words.several_joints)
    table.columns.insert(table.columns.begin() + 1, {"", "joint", "", true});
  const auto add = [&](const DesignPoint& point, const DesignJoint& joint, const std::string& name,
                       const std::string& unit, double value, double sd, double low, double high) {
    std::vector<std::string> row = {significant(1e3 * point.l_o, 4) + (point.is_own ? " own" : ""),
                                    name,
                                    unit,
                                    value_text(value, sd),
                                    significant(sd, 2),
                                    interval_text(low, high, sd)};
    if (words.several_joints) row.insert(row.begin() + 1, joint.name);
    table.rows.push_back(std::move(row));
  };
  for (const DesignPoint& point : result.points)
    for (const DesignJoint& joint : point.joints) {
      if (!joint.friction || point.radius_factor != 1) continue;
      const DesignFriction& f = *joint.friction;
      for (const DesignFriction::Part& p : f.parts)
        add(point, joint, p.name, p.unit, p.value.value, p.value.sd, p.value.low, p.value.high);
      if (f.parts.empty()) continue;
      add(point, joint, kDryFriction, words.torque, f.at_rest, f.sd, f.low, f.high);
      add(point, joint, "efficiency", "%", kPercent * f.efficiency_driving,
          joint.sd ? kPercent * joint.sd->efficiency_driving : kNotKnown,
          kPercent * f.efficiency_low, kPercent * f.efficiency_high);
    }
  return table;
}

const FrictionCurve* first_dry(const DesignResult& result) {
  return find_curve(result.friction, 0, kDryFriction);
}

std::string names_of(const std::vector<FittedFriction>& points) {
  std::string text;
  for (const FittedFriction& p : points) text += (text.empty() ? "" : ", ") + p.preload;
  return text;
}

std::string known_range(const FrictionWords& words, const FrictionCurve& curve) {
  if (!curve.by_tension)
    return fmt::format("l_o {} to {}", significant(1e3 * curve.line->low, kShort),
                       words.length(curve.line->high));
  double low = kUnbounded, high = 0;
  for (const FittedFriction& p : curve.points) {
    low = std::min(low, p.l_o);
    high = std::max(high, p.l_o);
  }
  return fmt::format("l_o {} to {} and a little beyond", significant(1e3 * low, kShort),
                     words.length(high));
}

}  // namespace

std::string friction_text(const DesignResult& result) {
  const FrictionCurve* dry = first_dry(result);
  if (dry == nullptr) return "";
  const FrictionWords words(result);
  if (dry->line)
    return fmt::format("fitted at {} preloads ({}): known for {}", dry->points.size(),
                       names_of(dry->points), known_range(words, *dry));
  if (dry->points.size() == 1)
    return fmt::format(
        "known at the fitted preload only, l_o {}; fit another preload, or give "
        "--tension-friction",
        words.length(dry->points.front().l_o));
  return fmt::format(
      "the fitted preloads ({}) have the same l_o {}: 'cablefit identify' finds l_o "
      "of each",
      names_of(dry->points), words.length(dry->points.front().l_o));
}

void add_friction_tables(const DesignResult& result, Document& document) {
  const FrictionWords words(result);
  if (!result.fitted.empty()) add_table(document, fitted_table(result, words));
  if (result.friction.empty()) return;
  add_detail(document, line_table(result, words));
  add_detail(document, part_table(result, words));
}

void add_friction_rows(const DesignResult& result, Document& document) {
  for (const DesignPoint& point : result.points)
    for (const DesignJoint& joint : point.joints) {
      if (!joint.friction) continue;
      const std::string where =
          fmt::format("l_o {} radii x {}{}", exact(point.l_o), exact(point.radius_factor),
                      point.joints.size() > 1 ? " joint " + joint.name : std::string());
      const auto add = [&](const std::string& name, const std::string& unit, double value) {
        add_tidy_number(document.tidy, where, "cables", "design", name, unit, value);
      };
      for (const DesignFriction::Part& p : joint.friction->parts)
        add(p.name, p.unit, p.value.value);
      add(kDryFriction, torque_unit(result.axes), joint.friction->at_rest);
      add("efficiency_driving", "", joint.friction->efficiency_driving);
    }
}

}  // namespace cablefit
