#include "cablefit/report/documents/refine_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/sections/refine_story.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kRankedRows = 8;

std::string number(double value) { return significant(value, kDigits); }
std::string whole_percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.0f}", 100 * share) : kNoNumber;
}

/// Of the search, or of what the joint shares with others where that names its effect.
double p_of(const RefineResult& r) {
  for (const NamedEffect& effect : r.effects)
    if (effect.evidence.n_draws == 0) return effect.evidence.p_value;
  return r.search_p;
}

std::string p_text(const RefineResult& r) {
  const double p = p_of(r);
  return p < kLeastTestP ? "< " + number(kLeastTestP) : number(p);
}

/// Of several joints what each has.
Table joint_table(const RefineResult& result) {
  const bool mixed = result.axes == Axes::mixed;  // then every number has its unit
  const std::string torque = mixed ? "" : torque_unit(result.axes);
  Table table;
  table.title = "Joints";
  table.columns = {{"", "joint", "", true},
                   {"", "verdict", "", true},
                   {"", "effect", "", true},
                   {"gap on test", "before", torque},
                   {"gap on test", "after", torque},
                   {"", "noise floor", torque},
                   {"", "p", ""}};
  for (const RefineResult& r : result.joints) {
    std::string effects;
    for (const NamedEffect& effect : r.effects)
      effects += (effects.empty() ? "" : ", ") + effect_text(effect, result);
    const bool is_done = r.not_refined.empty();
    const auto known = [&](double value, const std::string& unit) {
      return is_done ? number(value) + unit : kNoNumber;
    };
    const std::string unit = mixed ? " " + torque_unit(r.axes) : "";
    table.rows.push_back({r.joint_name, is_done ? std::string(to_string(r.verdict)) : "not refined",
                          effects, known(r.torque.test_before, unit),
                          known(r.torque.test_after, unit), known(r.torque.noise_floor, unit),
                          is_done ? p_text(r) : kNoNumber});
  }
  table.notes = {"each joint by its own equations, the measured motion of the others given"};
  return table;
}

Table joint_reasons(const RefineResult& result) {
  Table table;
  table.title = "Why, joint by joint";
  table.detail = true;
  table.columns = {{"", "joint", "", true}, {"", "reason", "", true}};
  for (const RefineResult& r : result.joints)
    table.rows.push_back({r.joint_name, r.not_refined.empty() ? r.reason : r.not_refined});
  return table;
}

Table where_table(const RefineResult& result) {
  const std::string torque = torque_unit(result.axes);
  Table table;
  table.title = "Where the gap is";
  table.detail = true;
  table.columns = {{"", "equation", "", true}, {"", "by", "", true},
                   {"", "where", "", true},    {"share of", "squared gap", "%"},
                   {"share of", "rows", "%"},  {"", "rms", torque},
                   {"", "noise floor", torque}};
  for (const Regime& r : result.where)
    table.rows.push_back({r.equation, r.regime, regime_text(r, result.axes),
                          whole_percent(r.share_of_squared_gap), whole_percent(r.share_of_rows),
                          number(r.rms), number(r.noise)});
  table.notes = {
      "before any effect was added; a share exceeds 100 % where other rows lie below "
      "the floor"};
  return table;
}

Table candidate_table(const RefineResult& result) {
  Table table;
  table.title = "Candidates for the first effect";
  table.detail = result.verdict == Verdict::none || !result.joints.empty();
  table.columns = {{"", "effect", "", true},
                   {"", "side", "", true},
                   {"removes of the", "squared gap", "%"},
                   {"best in", "resamples", "%"},
                   {"", "why not", "", true}};
  const std::size_t n = std::min(kRankedRows, result.ranking.size());
  for (std::size_t k = 0; k < n; ++k) {
    const Rival& row = result.ranking[k];
    table.rows.push_back({row.name, side_text(row.side, row.joint, result), whole_percent(row.gain),
                          whole_percent(row.inclusion), row.refused});
  }
  if (result.ranking.size() > n)
    table.notes.push_back(
        fmt::format("{} more candidates did no better", result.ranking.size() - n));
  return table;
}

std::string next_run_text(const NotSeparable& group) {
  if (group.is_alias) return "no log of the usual kind";
  if (group.next_run.empty()) return "none of those tried";
  if (group.still_together.empty()) return group.next_run;
  return fmt::format("{}, all but {}", group.next_run, fmt::join(group.still_together, ", "));
}

Table separability_table(const RefineResult& result) {
  Table table;
  table.title = "What these logs cannot separate";
  table.detail = true;
  table.columns = {
      {"", "effects", "", true}, {"", "from", "", true}, {"", "what separates them", "", true}};
  for (const NotSeparable& group : result.not_separable)
    table.rows.push_back({fmt::format("{}", fmt::join(group.effects, ", ")),
                          group.from_base ? "the model's own parameters" : "each other",
                          next_run_text(group)});
  table.notes = {
      "from the equations alone, without the residual: at a size that matters, one "
      "explains the other to within the noise"};
  return table;
}

Table step_table(const RefineResult& result) {
  const std::string torque = torque_unit(result.axes);
  Table table;
  table.title = "Steps";
  table.detail = true;
  table.columns = {{"", "added", "", true},     {"", "side", "", true},  {"gap", "train", torque},
                   {"gap", "held out", torque}, {"gap", "test", torque}, {"", "kept", "", true},
                   {"", "why not", "", true}};
  for (const RefineStep& step : result.steps)
    table.rows.push_back({step.added, side_text(step.side, step.joint, result),
                          number(step.gap_train), number(step.gap_held_out), number(step.gap_test),
                          step.accepted ? "yes" : "no", step.reason});
  return table;
}

/// In sd.
std::string change_text(double moved) {
  if (!std::isfinite(moved)) return kNoNumber;
  return fmt::format("{:+.{}f}", moved, std::abs(moved) < 9.95 ? 1 : 0);
}

/// Parameters before and after, all or those that moved.
Table shift_table(const RefineResult& result, bool all) {
  Table table;
  table.title = all ? "Parameters before and after" : "Parameters that moved";
  table.detail = all;
  table.columns = {{"", "parameter", "", true}, {"", "unit", "", true}, {"", "before", ""},
                   {"", "after", ""},           {"", "sd", ""},         {"", "change", "sd"}};
  if (result.effects.empty()) return table;  // then nothing moved them
  for (const ParameterShift& shift : result.shifts) {
    if (!all && !is_shifted(shift)) continue;
    table.rows.push_back({shift.name, shift.unit, value_text(shift.before, shift.sd),
                          value_text(shift.after, shift.sd), sd_text(shift.after, shift.sd),
                          change_text(moved_sd(shift))});
  }
  table.notes = {"before: the model given, fitted to the same logs in the same way"};
  return table;
}

void add_model_rows(Table& table, const Model& model) {
  const auto add = [&](const Estimate& e) {
    add_tidy(table, model.preload, "refined", "refine", e);
  };
  for (const Estimate& e : model.arm) add(e);
  for (const JointModel& joint : model.joints)
    for (const auto* side : {&joint.link, &joint.motor})
      for (const EffectInstance& instance : *side)
        for (const Estimate& e : instance.parameters) add(e);
  for (const Estimate& e : model.elastic) add(e);
}

void add_effect_rows(Table& table, const NamedEffect& effect, const RefineResult& result) {
  const Effect& row = *effect.instance.effect;
  const std::string method =
      fmt::format("{}.{}{}", row.name, to_string(row.site),
                  result.joints.empty() ? "" : fmt::format("[{}]", effect.joint));
  for (const auto* some : {&effect.instance.parameters, &effect.derived})
    for (const Estimate& e : *some) add_tidy(table, "", "refined", method, e);
}

void add_gap_rows(Table& table, const GapStory& gap, const std::string& what,
                  const std::string& unit) {
  if (!gap.known) return;
  const auto add = [&](const char* name, double value) {
    add_tidy_number(table, "", "refined", "refine", fmt::format("gap_{}_{}", what, name), unit,
                    value);
  };
  add("test_before", gap.test_before);
  add("test_after", gap.test_after);
  add("noise_floor", gap.noise_floor);
}

Table tidy_rows(const RefineResult& result) {
  Table table = tidy_table();
  for (const Model& model : result.models) add_model_rows(table, model);
  for (const KeptEffect& kept : result.kept) add_effect_rows(table, kept.now, result);
  for (const NamedEffect& effect : result.effects) add_effect_rows(table, effect, result);
  add_gap_rows(table, result.torque, "torque", torque_unit(result.axes));
  add_gap_rows(table, result.simulation, "simulation", unit_for(result.axes, "rad"));
  if (result.models.size() == 1)  // then all of it is about its preload
    for (auto& row : table.rows) row.front() = result.models.front().preload;
  return table;
}

}  // namespace

Document refine_document(const RefineResult& result, const std::vector<std::string>& model_files) {
  Document document;
  document.title = "What the model lacks";
  document.summary = refine_story(result, model_files);
  document.headline = refine_headline(result);
  for (Table table : {joint_table(result), joint_reasons(result), shift_table(result, false),
                      where_table(result), candidate_table(result), separability_table(result),
                      step_table(result), shift_table(result, true)})
    if (!table.rows.empty()) document.tables.push_back(std::move(table));
  if (!result.model_choice.empty())
    document.paragraphs.push_back(
        result.model_path.empty()
            ? fmt::format("Model: {}.", result.model_choice)
            : fmt::format("Model: {}, from {}.", result.model_choice, result.model_path));
  add_decisions(document, "", result.decisions);
  finish_decisions(document, 0);
  add_warnings(document, "", result.warnings);
  add_figures(document, result.figures);
  lead_with(document, 2);  // the residual, and the simulation of a test log
  document.tidy = tidy_rows(result);
  return document;
}

}  // namespace cablefit
