#include "cablefit/report/documents/dynamic_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "cablefit/figure/explained.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/equation_unit.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/sections/proof_report.hpp"
#include "cablefit/report/sections/validation_tables.hpp"

namespace cablefit {
namespace {

std::set<std::string> all_equations(const DynamicResult& result) {
  std::set<std::string> equations;
  for (const DynamicPreload& preload : result.preloads) {
    for (const DynamicFit& fit : preload.fits) {
      for (const auto& [equation, error] : fit.torque_error) equations.insert(equation);
    }
  }
  return equations;
}

Table error_table(const DynamicResult& result) {
  const Axes axes = axes_of(result.preloads);
  Table table;
  table.title = "Torque errors: the residual, relative to the torque to be explained";
  table.columns = {{"", "preload", "", true}, {"", "model", "", true}};
  const std::set<std::string> equations = all_equations(result);
  for (const std::string& equation : equations) {
    const std::string group = equation + " equation";
    table.columns.push_back({group, "rms", torque_unit(axes)});
    table.columns.push_back({group, "max", torque_unit(axes)});
    table.columns.push_back({group, "relative", "%"});
  }
  for (const DynamicPreload& preload : result.preloads) {
    for (const DynamicFit& fit : preload.fits) {
      std::vector<std::string> row = {preload.name, fit.model};
      for (const std::string& equation : equations) {
        const auto found = fit.torque_error.find(equation);
        const bool has = found != fit.torque_error.end();
        const TorqueError error = has ? found->second : TorqueError{};
        row.push_back(has ? significant(error.rms, kDigits) : kNoNumber);
        row.push_back(has ? significant(error.max_abs, kDigits) : kNoNumber);
        row.push_back(has ? significant(100 * error.relative, kDigits) : kNoNumber);
      }
      table.rows.push_back(row);
    }
  }
  return table;
}

/// What the test of each equation's regressors says; no rows where none was made.
Table verdict_table(const DynamicResult& result) {
  Table table;
  table.title = "Are regressors correlated with the residual (Durbin-Wu-Hausman)?";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "verdict", "", true}};
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      for (const auto& [equation, error] : fit.torque_error) {
        const auto found = fit.verdicts.find(equation + " equation");
        if (found == fit.verdicts.end()) continue;
        table.rows.push_back({preload.name, fit.model, equation, found->second});
      }
  return table;
}

Table sd_table(const DynamicResult& result) {
  Table table = both_sd_table({"preload", "model"});
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      add_sd_rows(table, {preload.name, fit.model}, fit.parameters);
  return table;
}

Table suspect_table(const DynamicResult& result) {
  Table table;
  table.title = "Suspect spans: where the residual exceeds the noise";
  const Axes axes = axes_of(result.preloads);
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "log", "", true},
                   {"", "from", "s"},
                   {"", "to", "s"},
                   {"", "largest", torque_unit(axes)}};
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      for (const SuspectSpan& span : fit.suspects)
        table.rows.push_back({preload.name, fit.model, span.equation,
                              span.run.empty() ? span.log : span.log + ", run " + span.run,
                              fmt::format("{:.3f}", span.from), fmt::format("{:.3f}", span.to),
                              significant(span.largest, kDigits)});
  return table;
}

/// "recursive, memory 2 s".
std::string rule_text(const OnlineRule& rule) {
  if (rule.memory == 0) return rule.method;
  return fmt::format("{}, memory {} s", rule.method, significant(rule.memory, 3));
}

/// Where each trace ends, against the direct answer.
Table online_table(const DynamicResult& result) {
  Table table;
  table.title = "Estimates updated row by row, at the end of the logs";
  table.columns = {{"", "preload", "", true}, {"", "model", "", true}, {"", "parameter", "", true},
                   {"", "unit", "", true},    {"", "direct", ""},      {"", "updated", "", true},
                   {"", "value", ""},         {"", "sd", ""},          {"", "difference [sd]", ""}};
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      for (std::size_t k = 0; !fit.traces.empty() && k < fit.traces.front().names.size(); ++k)
        for (const RecursiveTrace& trace : fit.traces) {
          const Estimate& e = fit.parameters[k];
          const OnlineEnd end = online_end(trace, k, e);
          if (!e.not_identifiable.empty() || !std::isfinite(end.value)) continue;
          table.rows.push_back({preload.name, fit.model, e.name, e.unit, value_text(e.value, e.sd),
                                rule_text(trace.rule), value_text(end.value, end.sd),
                                sd_text(end.value, end.sd), significant(end.difference, 2)});
        }
  if (!table.rows.empty())
    table.notes.emplace_back(
        "direct: the weighted fit to all rows, the answer of this result; difference: in sd of the "
        "updated estimate, which does not see all rows alike");
  return table;
}

/// One line per setting that was varied.
Table sweep_summary(const DynamicResult& result) {
  Table table;
  table.title = "Sweep: do the estimates depend on settings that should not matter?";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "setting", "", true},
                   {"", "verdict", "", true}};
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits) {
      if (!fit.sweep) continue;
      for (const SweepVerdict& verdict : fit.sweep->verdicts)
        table.rows.push_back({preload.name, fit.model, verdict.setting, verdict.text});
    }
  return table;
}

/// A table per preload, model and setting: parameters down, its values across.
std::vector<Table> sweep_tables(const DynamicResult& result) {
  std::vector<Table> tables;
  const auto table_of = [&](const DynamicPreload& preload, const DynamicFit& fit,
                            const std::string& setting) {
    Table table;
    table.title = fmt::format("Sweep: {}, {}, {}: change of every parameter in sd", preload.name,
                              fit.model, setting);
    table.columns = {{"", "parameter", "", true}};
    for (const std::string& parameter : fit.sweep->parameters) table.rows.push_back({parameter});
    for (const SweepPoint& point : fit.sweep->points) {
      if (point.setting != setting) continue;
      table.columns.push_back({setting, significant(point.value, kDigits), ""});
      for (std::size_t k = 0; k < table.rows.size(); ++k)
        table.rows[k].push_back(
            std::isfinite(point.change[k]) ? fmt::format("{:+.2f}", point.change[k]) : kNoNumber);
    }
    return table;
  };
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits) {
      if (!fit.sweep) continue;
      for (const SweepVerdict& verdict : fit.sweep->verdicts)
        tables.push_back(table_of(preload, fit, verdict.setting));
    }
  return tables;
}

std::vector<std::string> sweep_warnings(const DynamicFit& fit) {
  std::vector<std::string> warnings;
  if (!fit.sweep) return warnings;
  for (const SweepVerdict& verdict : fit.sweep->verdicts)
    if (!verdict.is_flat)
      warnings.push_back("not flat against " + verdict.setting + ": " + verdict.text);
  return warnings;
}

Table sd_reason_table(const DynamicResult& result) {
  Table table;
  table.title = "Which sd, and why";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "sd", "", true}};
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      for (const auto& [equation, reason] : fit.sd_reason)
        table.rows.push_back({preload.name, fit.model, equation, reason});
  return table;
}

Table conditioning_table(const DynamicResult& result) {
  Table table;
  table.title = "Conditioning";
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "cond(W)", ""},
                   {"", "effective rows", ""}};
  for (const DynamicPreload& preload : result.preloads) {
    for (const DynamicFit& fit : preload.fits) {
      for (const auto& [equation, condition] : fit.condition) {
        const auto rows = fit.effective_rows.find(equation);
        const double effective = rows == fit.effective_rows.end() ? 0 : rows->second;
        table.rows.push_back({preload.name, fit.model, equation, significant(condition, 3),
                              fmt::format("{:.0f}", effective)});
      }
    }
  }
  return table;
}

void add_tidy_rows(Table& table, const DynamicPreload& preload, const DynamicFit& fit) {
  for (const Estimate& e : fit.parameters) {
    add_tidy(table, preload.name, fit.model, fit.estimator, e);
  }
  for (const Estimate& e : fit.derived) add_tidy(table, preload.name, fit.model, fit.estimator, e);
  for (const auto& [equation, error] : fit.torque_error) {
    const std::string torque = equation_unit(preload, equation);
    const auto add = [&, name = equation](const char* what, const std::string& unit, double value) {
      add_tidy_number(table, preload.name, fit.model, fit.estimator,
                      fmt::format("torque_error_{}_{}", name, what), unit, value);
    };
    add("rms", torque, error.rms);
    add("max_abs", torque, error.max_abs);
    add("relative", "", error.relative);
  }
}

/// Of several models the one to use: the smallest error, unless a simpler one that stands before it
/// comes close. nullptr: no error is known.
const DynamicFit* better_fit(const DynamicPreload& preload) {
  constexpr double kClose = 1.05;  // of the relative errors of all equations together
  const DynamicFit* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const DynamicFit& fit : preload.fits) {
    double squares = fit.torque_error.empty() ? least : 0;
    for (const auto& [equation, error] : fit.torque_error)
      squares += error.relative * error.relative;
    const double error = std::sqrt(squares);
    if (!(kClose * error < least)) continue;
    least = error;
    best = &fit;
  }
  return best;
}

/// "link 0.169 N m rms (1.3 % of the torque), motor 0.167 N m rms (4.3 %)".
std::string residual_text(const DynamicPreload& preload, const DynamicFit& fit) {
  std::string text;
  for (const auto& [equation, error] : fit.torque_error)
    text += fmt::format("{}{} {} {} rms ({} %{})", text.empty() ? "" : ", ", equation,
                        significant(error.rms, kDigits), equation_unit(preload, equation),
                        significant(100 * error.relative, 2), text.empty() ? " of the torque" : "");
  return text;
}

/// On what the residual of that model depends, of all equations.
std::string dependence_text(const DynamicPreload& preload, const std::string& model) {
  std::string text, first;
  bool is_same = true;
  for (const JudgedEquation& e : preload.residual_tests) {
    if (e.model != model) continue;
    const std::string depends = depends_text(e, equation_unit(preload, e.equation));
    if (text.empty()) first = depends;
    is_same = is_same && depends == first;
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", e.equation, depends);
  }
  return is_same ? first : text;
}

/// Of several joints a line per equation.
void add_answers(const DynamicPreload& preload, const DynamicFit& fit, Document& document) {
  for (const auto& [equation, error] : fit.torque_error) {
    std::string depends;
    for (const JudgedEquation& e : preload.residual_tests)
      if (e.model == fit.model && e.equation == equation)
        depends = "; against motion: " + depends_text(e, equation_unit(preload, equation));
    const bool is_first = equation == fit.torque_error.begin()->first;
    document.summary.push_back(
        {is_first ? preload.name : "",
         fmt::format("{}: residual {} {} rms, {} % of the torque{}", equation,
                     significant(error.rms, kDigits), equation_unit(preload, equation),
                     significant(100 * error.relative, 2), depends)});
  }
}

void add_answer(const DynamicPreload& preload, Document& document) {
  constexpr std::size_t kOneJoint = 2;  // equations
  const DynamicFit* best = better_fit(preload);
  if (best == nullptr) return;
  if (best->torque_error.size() > kOneJoint && preload.fits.size() == 1) {
    add_answers(preload, *best, document);
    return;
  }
  const std::string use = preload.fits.size() > 1 ? "use " + best->model + "; " : "";
  document.summary.push_back(
      {preload.name, fmt::format("{}residual: {}", use, residual_text(preload, *best))});
  if (const std::string depends = dependence_text(preload, best->model); !depends.empty())
    document.summary.push_back({"", "residual against motion and load: " + depends});
  for (const DynamicFit& fit : preload.fits)
    if (&fit != best)
      document.summary.push_back(
          {"  " + fit.model, fmt::format("residual: {}", residual_text(preload, fit))});
}

/// Share of the squared torque of an equation that the best model of every preload explains.
void add_explained(const DynamicResult& result, const char* equation, Headline& headline) {
  std::vector<NamedNumber> shares;
  for (const DynamicPreload& preload : result.preloads) {
    const DynamicFit* best = better_fit(preload);
    if (best == nullptr || !best->torque_error.contains(equation)) continue;
    const double relative = best->torque_error.at(equation).relative;
    shares.push_back({preload.name, explained_percent(1, relative * relative)});
  }
  if (!shares.empty())
    headline.numbers.push_back(
        {fmt::format("{} torque explained", equation), joined_numbers(shares)});
}

void add_inertia(const DynamicResult& result, Headline& headline) {
  for (const char* name : {"J_link", "J"}) {
    std::vector<NamedNumber> values;
    std::vector<std::string> missing;
    std::string unit;
    for (const DynamicPreload& preload : result.preloads) {
      const DynamicFit* best = better_fit(preload);
      const Estimate* e = best == nullptr ? nullptr : find_estimate(best->parameters, name);
      if (e == nullptr) continue;
      if (!e->not_identifiable.empty()) {
        missing.push_back(preload.name);
        continue;
      }
      values.push_back({preload.name, headline_value(*e)});
      unit = e->unit;
    }
    if (values.empty()) continue;
    std::string text = joined_numbers(values) + " " + unit;
    if (!missing.empty()) text += fmt::format(", not determined: {}", fmt::join(missing, ", "));
    headline.numbers.push_back({name, std::move(text)});
    return;
  }
}

Headline headline_of(const DynamicResult& result) {
  Headline headline;
  std::size_t n = 0, n_missing = 0;
  for (const DynamicPreload& preload : result.preloads) {
    const DynamicFit* best = better_fit(preload);
    if (best == nullptr) continue;
    for (const Estimate& e : best->parameters) {
      ++n;
      n_missing += e.not_identifiable.empty() ? 0 : 1;
    }
    headline.verdict += fmt::format("{}{}: use {}", headline.verdict.empty() ? "" : "; ",
                                    preload.name, best->model);
  }
  headline.word = n_missing == 0 ? "identified" : "partly identified";
  headline.tone = n_missing == 0 ? Tone::good : Tone::neutral;
  headline.verdict += fmt::format("; {} of {} parameters identified", n - n_missing, n);
  for (const char* equation : {"motor", "link", "torque"})
    add_explained(result, equation, headline);
  add_inertia(result, headline);
  return headline;
}

}  // namespace

Document dynamic_document(const DynamicResult& result) {
  Document document;
  document.title = "Stage 2, link moving: inertias, friction and offset";
  document.tidy = tidy_table();
  Table counts = counts_table(), derived = derived_table();
  add_warnings(document, "", result.warnings);
  for (const DynamicPreload& preload : result.preloads) {
    for (const auto& [equation, rows] : preload.counts) {
      add_counts(counts, preload.name, equation, rows, preload.windows);
    }
    add_answer(preload, document);
    add_decisions(document, preload.name, preload.decisions);
    add_warnings(document, preload.name, preload.warnings);
    add_figures(document, preload.figures);
    for (const DynamicFit& fit : preload.fits) {
      add_warnings(document, preload.name + ", " + fit.model, fit.warnings);
      add_warnings(document, preload.name + ", " + fit.model, sweep_warnings(fit));
      add_tidy_rows(document.tidy, preload, fit);
      add_derived(derived, preload.name + ", " + fit.model, fit.derived);
    }
    add_validation_rows(document.tidy, preload);
    add_warnings(document, preload.name, validation_warnings(preload));
  }
  finish_decisions(document, result.preloads.size());
  document.headline = headline_of(result);
  lead_with(document, 1);
  document.tables = parameter_tables(result);
  add_table(document, sweep_summary(result));
  for (Table& table : sweep_tables(result)) add_detail(document, std::move(table));
  for (Table& table : validation_tables(result)) add_table(document, std::move(table));
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      if (fit.proof)
        add_table(document,
                  proof_table(fmt::format("{}, {} by {}", preload.name, fit.model, fit.estimator),
                              *fit.proof));
  add_table(document, online_table(result));
  add_table(document, suspect_table(result));
  if (Table errors = error_table(result); errors.columns.size() > 2)
    add_detail(document, std::move(errors));
  add_detail(document, verdict_table(result));
  add_detail(document, residual_summary(result));
  add_detail(document, residual_table(result));
  add_detail(document, sd_reason_table(result));
  add_detail(document, std::move(derived));
  add_detail(document, sd_table(result));
  add_detail(document, conditioning_table(result));
  add_detail(document, std::move(counts));
  return document;
}

}  // namespace cablefit
