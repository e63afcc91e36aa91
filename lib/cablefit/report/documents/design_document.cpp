#include "cablefit/report/documents/design_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/sections/friction_report.hpp"
#include "cablefit/report/sections/load_report.hpp"
#include "cablefit/report/sections/polytope_report.hpp"
#include "cablefit/report/sections/stiffness_report.hpp"

namespace cablefit {
namespace {

constexpr int kFewDigits = 3;

constexpr double kNothing = 1e-9;  // rounding of what is 0

std::string few(double value) {
  if (std::isinf(value)) return "never";
  return significant(std::abs(value) < kNothing ? 0 : value, kFewDigits);
}

struct Words {
  const DesignResult& result;
  std::string torque, stiffness, angle, elongation, tension;

  explicit Words(const DesignResult& r)
      : result(r),
        torque(torque_unit(r.axes)),
        stiffness(unit_for(r.axes, "N m/rad")),
        angle(unit_for(r.axes, "mrad")),
        elongation(r.cable_space ? "mm" : unit_for(r.axes, "mrad")),
        tension(r.cable_space ? "N" : torque_unit(r.axes)) {}

  bool several_joints() const { return result.points.front().joints.size() > 1; }
  bool several_radii() const { return result.needed.size() > 1; }

  /// Leading columns that say which design a row is of.
  std::vector<Column> key_columns() const {
    std::vector<Column> columns = {{"", "l_o", elongation}};
    if (several_radii()) columns.push_back({"", "radii x", ""});
    if (several_joints()) columns.push_back({"", "joint", "", true});
    return columns;
  }
  std::vector<std::string> key(const DesignPoint& point, const DesignJoint& joint) const {
    std::vector<std::string> cells = {significant(1e3 * point.l_o, kFineDigits) +
                                      (point.is_own ? " own" : "")};
    if (several_radii()) cells.push_back(significant(point.radius_factor, kFineDigits));
    if (several_joints()) cells.push_back(joint.name);
    return cells;
  }
};

Table table_of(const Words& words, const std::string& title, const std::vector<Column>& columns) {
  Table table;
  table.title = title;
  table.columns = words.key_columns();
  table.columns.insert(table.columns.end(), columns.begin(), columns.end());
  return table;
}

void add_row(Table& table, std::vector<std::string> key, const std::vector<std::string>& cells) {
  key.insert(key.end(), cells.begin(), cells.end());
  table.rows.push_back(std::move(key));
}

/// `add` is called for every joint of every point.
template <typename Add>
void for_each_joint(const DesignResult& result, Add add) {
  for (const DesignPoint& point : result.points)
    for (const DesignJoint& joint : point.joints) add(point, joint);
}

Table preload_table(const Words& words) {
  Table table = table_of(words, "Effect of the preload",
                         {{"all cables taut", "up to", words.torque},
                          {"all cables taut", "from", words.angle},
                          {"all cables taut", "to", words.angle},
                          {"slack", "first", "", true},
                          {"stiffness", "no load", words.stiffness},
                          {"stiffness", "at -torque", words.stiffness},
                          {"stiffness", "at +torque", words.stiffness},
                          {"stiffness", "least", words.stiffness},
                          {"stiffness", "most", words.stiffness}});
  for_each_joint(words.result, [&](const DesignPoint& point, const DesignJoint& joint) {
    add_row(table, words.key(point, joint),
            {few(joint.closure_torque), few(1e3 * joint.closure_low), few(1e3 * joint.closure_high),
             joint.slack_first.empty() ? kNoNumber : joint.slack_first,
             significant(joint.stiffness_zero, kFineDigits),
             significant(joint.stiffness_low, kFineDigits),
             significant(joint.stiffness_high, kFineDigits),
             significant(joint.stiffness_least, kFineDigits),
             significant(joint.stiffness_most, kFineDigits)});
  });
  table.notes.push_back(
      fmt::format("torque: {:g} {}; l_o: initial elongation of cable {}, the "
                  "others in equilibrium with it (8c)",
                  words.result.torque, words.torque, words.result.cables.front()));
  return table;
}

Table cost_table(const Words& words) {
  Table table = table_of(words, "Error of simpler models",
                         {{"", "model", "", true},
                          {"largest error", "torque", words.torque},
                          {"largest error", "of torque", "%"},
                          {"largest error", "at", words.angle},
                          {"", "position under load", words.angle},
                          {"free resonance", "from", "Hz"},
                          {"free resonance", "to", "Hz"},
                          {"", "smallest collision", words.torque}});
  for_each_joint(words.result, [&](const DesignPoint& point, const DesignJoint& joint) {
    for (const ModelCost& cost : joint.models)
      add_row(table, words.key(point, joint),
              {cost.model, few(cost.max_error), few(100 * cost.max_error / words.result.torque),
               cost.max_error > kNothing ? few(1e3 * cost.at) : kNoNumber,
               few(1e3 * cost.static_error), few(cost.resonance_low), few(cost.resonance_high),
               cost.collision ? few(cost.collision->torque) : kNoNumber});
  });
  table.notes.push_back(
      "of the best model of each kind on the working range; position under load: "
      "largest error of the joint's position when the model corrects for it; "
      "cables: the model that was given");
  if (words.result.detector) {
    const CollisionDetector& d = *words.result.detector;
    table.notes.push_back(fmt::format(
        "smallest collision: link torque that a mean of the residual over {:g} s at "
        "{:g} Hz detects with a probability of {:g} within two windows, at {:g} false "
        "alarm{} an hour, {}, for any model error up to the largest{}",
        d.window, d.rate, d.detection_rate, words.result.false_alarms_per_hour,
        words.result.false_alarms_per_hour == 1 ? "" : "s",
        d.mean_noise ? fmt::format("sd of such a mean {:.3g} {}", *d.mean_noise, words.torque)
                     : fmt::format("torque noise {:g} {}, white", d.noise, words.torque),
        d.model_error > 0 ? fmt::format(" and {:g} {}", d.model_error, words.torque) : ""));
  }
  return table;
}

Table friction_table(const Words& words) {
  Table table = table_of(words, "Friction and efficiency",
                         {{"dry friction", "no load", words.torque},
                          {"dry friction", "driving", words.torque},
                          {"dry friction", "driven", words.torque},
                          {"efficiency", "driving", "%"},
                          {"efficiency", "driven", "%"}});
  for_each_joint(words.result, [&](const DesignPoint& point, const DesignJoint& joint) {
    if (!joint.friction) {
      if (!words.result.friction.empty())
        add_row(table, words.key(point, joint), std::vector<std::string>(5, kNoNumber));
      return;
    }
    const DesignFriction& f = *joint.friction;
    add_row(table, words.key(point, joint),
            {few(f.at_rest), few(f.driving), few(f.driven), few(100 * f.efficiency_driving),
             few(100 * f.efficiency_driven)});
  });
  table.notes.push_back(
      fmt::format("slow motion; driving: the motor lifts {:g} {}, driven: the "
                  "load moves the motor; 0 %: it locks",
                  words.result.torque, words.torque));
  return table;
}

/// Nothing where the model has no covariance.
Table spread_table(const Words& words) {
  Table table = table_of(words, "Standard deviations of the design",
                         {{"closure torque", "", words.torque},
                          {"closure torque", "sd", words.torque},
                          {"stiffness, no load", "", words.stiffness},
                          {"stiffness, no load", "sd", words.stiffness},
                          {"stiffness, +torque", "", words.stiffness},
                          {"stiffness, +torque", "sd", words.stiffness},
                          {"efficiency", "driving", "%"},
                          {"efficiency", "sd", "%"}});
  for_each_joint(words.result, [&](const DesignPoint& point, const DesignJoint& joint) {
    if (!joint.sd) return;
    const auto sd = [](double value) { return significant(value, 2); };
    add_row(table, words.key(point, joint),
            {few(joint.closure_torque), sd(joint.sd->closure_torque),
             significant(joint.stiffness_zero, kFineDigits), sd(joint.sd->stiffness_zero),
             significant(joint.stiffness_high, kFineDigits), sd(joint.sd->stiffness_high),
             joint.friction ? few(100 * joint.friction->efficiency_driving) : kNoNumber,
             sd(100 * joint.sd->efficiency_driving)});
  });
  table.notes = {"sd: from the joint covariance of the model's parameters"};
  return table;
}

Table tension_table(const Words& words) {
  Table table = table_of(words, "Tension of each cable",
                         {{"", "cable", "", true},
                          {"", "l_o", words.elongation},
                          {"tension", "no load", words.tension},
                          {"tension", "least", words.tension},
                          {"tension", "largest", words.tension}});
  for_each_joint(words.result, [&](const DesignPoint& point, const DesignJoint& joint) {
    for (std::size_t k = 0; k < joint.tensions.size(); ++k) {
      const TensionRange& t = joint.tensions[k];
      add_row(table, words.key(point, joint),
              {t.cable, significant(1e3 * point.initial_elongations[k], kFineDigits),
               few(t.preload), few(t.least), few(t.largest)});
    }
  });
  return table;
}

std::string needed_text(const Words& words, const NeededPreload& needed) {
  if (!std::isfinite(needed.l_o)) return "none is enough";
  std::string text;
  for (std::size_t k = 0; k < needed.initial_elongations.size(); ++k)
    text += fmt::format("{}l_o[{}] = {} {}", k > 0 ? ", " : "", words.result.cables[k],
                        significant(1e3 * needed.initial_elongations[k], kFineDigits),
                        words.elongation);
  return text +
         fmt::format(" keeps all cables taut up to {:g} {}", words.result.torque, words.torque);
}

/// The paper's claim in numbers: what a straight line gets wrong, at each end of the sweep.
void add_claim(const Words& words, Document& document) {
  const auto text = [&](const DesignPoint& point) {
    const DesignJoint& joint = point.joints.front();
    return fmt::format("l_o {} {}: linear {}, piecewise linear {} {}",
                       significant(1e3 * point.l_o, kFineDigits), words.elongation,
                       few(joint.model("linear").max_error),
                       few(joint.model("piecewise linear").max_error), words.torque);
  };
  const std::vector<DesignPoint>& points = words.result.points;
  document.summary.push_back({"largest error", text(points.front())});
  if (points.size() > 1) document.summary.push_back({"", text(points.back())});
}

void add_tidy_rows(const Words& words, Document& document) {
  for_each_joint(words.result, [&](const DesignPoint& point, const DesignJoint& joint) {
    const std::string where =
        fmt::format("l_o {} radii x {}{}", exact(point.l_o), exact(point.radius_factor),
                    words.several_joints() ? " joint " + joint.name : std::string());
    const auto add = [&](const std::string& model, const std::string& name, const std::string& unit,
                         double value) {
      add_tidy_number(document.tidy, where, model, "design", name, unit, value);
    };
    const std::string rad = unit_for(words.result.axes, "rad");
    add("cables", "closure_torque", words.torque, joint.closure_torque);
    add("cables", "closure_low", rad, joint.closure_low);
    add("cables", "closure_high", rad, joint.closure_high);
    add("cables", "stiffness_zero", words.stiffness, joint.stiffness_zero);
    add("cables", "stiffness_least", words.stiffness, joint.stiffness_least);
    add("cables", "stiffness_most", words.stiffness, joint.stiffness_most);
    for (const TensionRange& t : joint.tensions)
      add("cables", "tension[" + t.cable + "]", words.tension, t.preload);
    for (const ModelCost& cost : joint.models) {
      add(cost.model, "max_error", words.torque, cost.max_error);
      add(cost.model, "static_error", rad, cost.static_error);
      if (std::isfinite(cost.resonance_low)) {
        add(cost.model, "resonance_low", "Hz", cost.resonance_low);
        add(cost.model, "resonance_high", "Hz", cost.resonance_high);
      }
      if (cost.collision) add(cost.model, "collision_torque", words.torque, cost.collision->torque);
    }
  });
}

Table excitation_table(const ExcitationPlan& plan) {
  Table table;
  table.title = "Expected uncertainty from this motion";
  table.columns = {{"", "equation", "", true}, {"", "parameter", "", true}, {"", "unit", "", true},
                   {"", "value", ""},          {"to expect", "error", ""},  {"to expect", "", "%"},
                   {"of which", "sd", ""},     {"of which", "floor", ""},   {"", "sd (25)", ""},
                   {"plain sine", "error", ""}};
  for (std::size_t k = 0; k < plan.fit.parameters.size(); ++k) {
    const PlannedParameter& p = plan.fit.parameters[k];
    table.rows.push_back(
        {p.equation, p.name, p.unit, significant(p.value, kFineDigits), significant(p.error(), 2),
         significant(100 * p.error() / std::abs(p.value), 2), significant(p.sd, 2),
         significant(std::abs(p.floor), 2), significant(p.sd_white, 2),
         k < plan.plain.fit.parameters.size() ? significant(plan.plain.fit.parameters[k].error(), 2)
                                              : std::string(kNoNumber)});
  }
  table.notes.push_back(
      "error: root of sd^2 + floor^2; sd: scatter from sensor noise; floor: error of filters and "
      "of kinks where cables go slack, without noise; not included: errors of stage 1, effects "
      "missing in the model, and the bias of least squares from noise in the regressors "
      "('--estimator iv' has none)");
  table.notes.push_back(fmt::format(
      "plain sine: {} Hz, all of the range at full speed{}", significant(plan.plain.hz, kFewDigits),
      plan.plain.fit.refused.empty()
          ? std::string()
          : "; 'cablefit dynamic' refuses it: " + plan.plain.fit.refused));
  return table;
}

void add_excitation(const DesignResult& result, Document& document) {
  const ExcitationPlan& plan = *result.excitation;
  const std::string rad = unit_for(result.axes, "rad");
  document.summary.push_back(
      {"reference",
       fmt::format("{}: {} of {:g} s at {:g} Hz, best of {} simulated", result.excitation_path,
                   plan.shape, plan.limits.duration, plan.limits.rate, plan.n_tried)});
  document.summary.push_back(
      {"worst error",
       fmt::format(
           "{} %, of a plain sine {} %: {} times as much", significant(100 * plan.fit.worst(), 2),
           std::isfinite(plan.plain.worst) ? significant(100 * plan.plain.worst, 2) : "unknown",
           std::isfinite(plan.factor()) ? significant(plan.factor(), 2) : "infinitely many")});
  document.summary.push_back(
      {"limits", fmt::format("{:.0f} % of {:g} {}, {:.0f} % of {:g} {}/s, {:.0f} % of {:g} {}",
                             100 * plan.motion.position_share, plan.limits.max_position, rad,
                             100 * plan.motion.speed_share, plan.limits.max_speed, rad,
                             100 * plan.motion.torque_share, plan.limits.max_torque,
                             torque_unit(result.axes))});
  document.tables.push_back(excitation_table(plan));
  add_figures(document, plan.figures);
  add_decisions(document, result.preload, plan.decisions);
  for (const PlannedParameter& p : plan.fit.parameters) {
    const auto add = [&](const std::string& name, double value) {
      add_tidy_number(document.tidy, "excitation", "cables", plan.shape, name + " of " + p.name,
                      p.unit, value);
    };
    add("error", p.error());
    add("sd", p.sd);
    add("floor", p.floor);
    add("sd_white", p.sd_white);
  }
}

void add_sweep(const DesignResult& result, Document& document) {
  const Words words(result);
  for (const NeededPreload& needed : result.needed)
    document.summary.push_back({words.several_radii()
                                    ? fmt::format("preload, radii x {:g}", needed.radius_factor)
                                    : std::string("preload"),
                                needed_text(words, needed)});
  add_claim(words, document);
  if (const std::string text = friction_text(result); !text.empty())
    document.summary.push_back({"friction", text});
  add_table(document, preload_table(words));
  add_detail(document, cost_table(words));
  add_detail(document, friction_table(words));
  add_friction_tables(result, document);
  add_detail(document, spread_table(words));
  add_detail(document, tension_table(words));
  add_figures(document, result.figures);
  add_tidy_rows(words, document);
  add_friction_rows(result, document);
}

/// Least and largest among the designs of the sweep.
template <typename Number>
std::string range_text(const DesignResult& result, const std::string& unit, Number number) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const DesignPoint& point : result.points) {
    least = std::min(least, number(point.joints.front()));
    most = std::max(most, number(point.joints.front()));
  }
  const std::string from = few(least), to = few(most);
  return (from == to ? from : from + " .. " + to) + " " + unit;
}

Headline headline_of(const DesignResult& result) {
  Headline headline;
  if (!result.points.empty()) {
    const Words words(result);
    if (!result.needed.empty()) headline.verdict = needed_text(words, result.needed.front());
    headline.numbers = {
        {"all cables taut up to",
         range_text(result, words.torque, [](const DesignJoint& j) { return j.closure_torque; })},
        {"stiffness without load",
         range_text(result, words.stiffness,
                    [](const DesignJoint& j) { return j.stiffness_zero; })},
        {"largest error of a linear spring",
         range_text(result, words.torque,
                    [](const DesignJoint& j) { return j.model("linear").max_error; })}};
  } else if (result.excitation) {
    const ExcitationPlan& plan = *result.excitation;
    headline.verdict = fmt::format("record {} of {:g} s", plan.shape, plan.limits.duration);
    headline.numbers = {
        {"worst error", significant(100 * plan.fit.worst(), 2) + " %"},
        {"worst error of a plain sine", significant(100 * plan.plain.worst, 2) + " %"}};
  }
  return headline;
}

}  // namespace

Document design_document(const DesignResult& result) {
  Document document;
  document.tidy = tidy_table();
  const bool sweep = !result.points.empty();
  const bool cables = !sweep && !result.excitation;
  document.title = cables ? "Design: the cables as they are"
                   : !result.excitation
                       ? "Design: effect of the preload, and error of simpler models"
                   : sweep ? "Design: effect of the preload, and which motion to record"
                           : "Design: which motion to record";
  document.summary.push_back({"model", result.model_choice});
  if (sweep) add_sweep(result, document);
  add_decisions(document, result.preload, result.decisions);
  add_stiffness(result, document);
  add_held_loads(result, document);
  add_polytopes(result, document);
  if (!sweep) add_figures(document, result.figures);
  if (result.excitation) add_excitation(result, document);
  finish_decisions(document, 1);
  document.headline = headline_of(result);
  lead_with(document, 1);
  document.warnings = result.warnings;
  return document;
}

}  // namespace cablefit
