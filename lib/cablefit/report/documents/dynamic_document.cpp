#include "cablefit/report/documents/dynamic_document.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "cablefit/report/documents/document_parts.hpp"
#include "cablefit/report/documents/numbers.hpp"
#include "cablefit/report/documents/proof_report.hpp"
#include "cablefit/report/documents/validation_tables.hpp"

namespace cablefit {
namespace {

constexpr int kErrorDigits = 3;

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
  const bool linear_motion = !result.preloads.empty() && result.preloads.front().linear_motion;
  Table table;
  table.title = "Torque errors: the residual, relative to the torque to be explained";
  table.columns = {{"", "preload", "", true}, {"", "model", "", true}};
  const std::set<std::string> equations = all_equations(result);
  for (const std::string& equation : equations) {
    const std::string group = equation + " equation";
    table.columns.push_back({group, "rms", torque_unit(linear_motion)});
    table.columns.push_back({group, "max", torque_unit(linear_motion)});
    table.columns.push_back({group, "relative", "%"});
  }
  for (const DynamicPreload& preload : result.preloads) {
    for (const DynamicFit& fit : preload.fits) {
      std::vector<std::string> row = {preload.name, fit.model};
      for (const std::string& equation : equations) {
        const auto found = fit.torque_error.find(equation);
        const bool has = found != fit.torque_error.end();
        const TorqueError error = has ? found->second : TorqueError{};
        row.push_back(has ? significant(error.rms, kErrorDigits) : kNoNumber);
        row.push_back(has ? significant(error.max_abs, kErrorDigits) : kNoNumber);
        row.push_back(has ? significant(100 * error.relative, kErrorDigits) : kNoNumber);
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
  Table table;
  table.title = "Standard deviations: the one cablefit stands behind, and the paper's (25)";
  table.columns = {{"", "preload", "", true},   {"", "model", "", true},
                   {"", "parameter", "", true}, {"", "unit", "", true},
                   {"", "value", ""},           {"", "sd", ""},
                   {"", "sd of (25)", ""},      {"95 % interval", "from", ""},
                   {"95 % interval", "to", ""}};
  table.detail = true;
  for (const DynamicPreload& preload : result.preloads) {
    for (const DynamicFit& fit : preload.fits) {
      for (const Estimate& e : fit.parameters) {
        if (!e.not_identifiable.empty()) continue;
        table.rows.push_back({preload.name, fit.model, e.name, e.unit, value_text(e.value, e.sd),
                              sd_text(e.value, e.sd), significant(e.sd_white, 2),
                              value_text(e.ci_low, e.sd), value_text(e.ci_high, e.sd)});
      }
    }
  }
  return table;
}

Table suspect_table(const DynamicResult& result) {
  Table table;
  table.title = "Suspect spans: where the residual sticks out of what noise explains";
  const bool linear = !result.preloads.empty() && result.preloads.front().linear_motion;
  table.columns = {{"", "preload", "", true},
                   {"", "model", "", true},
                   {"", "equation", "", true},
                   {"", "log", "", true},
                   {"", "from", "s"},
                   {"", "to", "s"},
                   {"", "largest", torque_unit(linear)}};
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      for (const SuspectSpan& span : fit.suspects)
        table.rows.push_back({preload.name, fit.model, span.equation,
                              span.run.empty() ? span.log : span.log + ", run " + span.run,
                              fmt::format("{:.3f}", span.from), fmt::format("{:.3f}", span.to),
                              significant(span.largest, kErrorDigits)});
  return table;
}

/// A table per preload and model: parameters down, settings across.
std::vector<Table> sweep_tables(const DynamicResult& result) {
  std::vector<Table> tables;
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits) {
      if (!fit.sweep) continue;
      Table table;
      table.title =
          fmt::format("Sweep: {}, {}: change of every parameter in sd", preload.name, fit.model);
      table.columns = {{"", "parameter", "", true}};
      for (const SweepPoint& point : fit.sweep->points)
        table.columns.push_back({point.setting, significant(point.value, kErrorDigits), ""});
      for (std::size_t k = 0; k < fit.sweep->parameters.size(); ++k) {
        std::vector<std::string> row = {fit.sweep->parameters[k]};
        for (const SweepPoint& point : fit.sweep->points)
          row.push_back(std::isfinite(point.change[k]) ? fmt::format("{:+.2f}", point.change[k])
                                                       : kNoNumber);
        table.rows.push_back(row);
      }
      for (const SweepVerdict& verdict : fit.sweep->verdicts)
        table.notes.push_back(verdict.setting + ": " + verdict.text);
      tables.push_back(std::move(table));
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
  table.detail = true;
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
  const std::string torque = torque_unit(preload.linear_motion);
  for (const auto& [equation, error] : fit.torque_error) {
    const auto add = [&, name = equation](const char* what, const std::string& unit, double value) {
      add_tidy_number(table, preload.name, fit.model, fit.estimator,
                      fmt::format("torque_error_{}_{}", name, what), unit, value);
    };
    add("rms", torque, error.rms);
    add("max_abs", torque, error.max_abs);
    add("relative", "", error.relative);
  }
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
  document.tables = parameter_tables(result);
  const Table errors = error_table(result);
  if (errors.columns.size() > 2) document.tables.push_back(errors);
  const Table verdicts = verdict_table(result);
  if (!verdicts.rows.empty()) document.tables.push_back(verdicts);
  if (Table suspects = suspect_table(result); !suspects.rows.empty())
    document.tables.push_back(std::move(suspects));
  for (Table& table : sweep_tables(result)) document.tables.push_back(std::move(table));
  for (Table& table : validation_tables(result)) document.tables.push_back(std::move(table));
  if (const Table summary = residual_summary(result); !summary.rows.empty()) {
    document.tables.push_back(summary);
    document.tables.push_back(residual_table(result));
  }
  for (const DynamicPreload& preload : result.preloads)
    for (const DynamicFit& fit : preload.fits)
      if (fit.proof)
        document.tables.push_back(proof_table(
            fmt::format("{}, {} by {}", preload.name, fit.model, fit.estimator), *fit.proof));
  if (Table reasons = sd_reason_table(result); !reasons.rows.empty())
    document.tables.push_back(std::move(reasons));
  if (!derived.rows.empty()) document.tables.push_back(std::move(derived));
  document.tables.push_back(sd_table(result));
  document.tables.push_back(conditioning_table(result));
  document.tables.push_back(counts);
  return document;
}

}  // namespace cablefit
