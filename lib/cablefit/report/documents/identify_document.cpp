#include "cablefit/report/documents/identify_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/axes.hpp"
#include "cablefit/model/modes.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/estimate_cells.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

constexpr double kAsSd = 0.1;  // sd: an interval that ends there is that of the sd

std::string label(const Estimate& e) {
  const bool same = e.name == e.symbol || e.name.starts_with(e.symbol + "[");
  return same ? e.name : e.name + " (" + e.symbol + ")";
}

bool is_elongation(const Estimate& e) { return e.name.starts_with("l_o["); }

std::string cad_text(const Estimate& e) {
  return std::isnan(e.cad) ? kNoNumber : fmt::format("{:g}", e.cad);
}

/// Whether an end of the interval of the profile is off that of value -+ 2 sd by a tenth of the sd
/// or more; its own end may be open.
bool differs_from_sd(const Estimate& e) {
  const auto off = [&](double end, double expected) {
    return !(std::abs(end - expected) < kAsSd * e.sd);
  };
  return off(e.ci_low, e.value - 2 * e.sd) || off(e.ci_high, e.value + 2 * e.sd);
}

/// "r_m[a]: 95 % interval 0.0299 .. 0.0302 m by profile likelihood", where the sd does not give it.
void note_profiles(const std::vector<Estimate>& parameters, Table& table) {
  for (const Estimate& e : parameters) {
    if (!e.name.starts_with("r_m[") || !e.profiled || !e.not_identifiable.empty()) continue;
    if (!differs_from_sd(e)) continue;
    const auto end = [&](double value) {
      return std::isnan(value) ? std::string("?") : value_text(value, e.sd);
    };
    table.notes.push_back(fmt::format("{}: 95 % interval {} .. {} {} by profile likelihood", e.name,
                                      end(e.ci_low), end(e.ci_high), e.unit));
  }
}

/// Rows with sd of these parameters, but for l_o.
void add_parameter_rows(const IdentifyResult& result, const std::vector<Estimate>& parameters,
                        Footnotes& notes, Table& table) {
  const double load = result.preloads.front().load_inertia;
  for (const Estimate& e : parameters) {
    if (is_elongation(e)) continue;
    EstimateCells cells = cells_of(&e, notes);
    const bool has_sd = e.not_identifiable.empty();
    table.rows.push_back({label(e), e.unit, cad_text(e), cells.value,
                          has_sd ? sd_text(e.value, e.sd) : "", cells.rsd});
    if (e.name != "J_link" || !(load > 0)) continue;
    cells = cells_without_load(&e, load);
    table.rows.push_back({"  without the load", e.unit, kNoNumber, cells.value, "", cells.rsd});
  }
}

/// What all preloads have in common; all parameters where there is one preload.
Table shared_table(const IdentifyResult& result) {
  Table table;
  Footnotes notes;
  const bool is_alone = result.preloads.size() == 1;
  table.title = is_alone ? "All parameters (Table 2)" : "Shared by all preloads";
  table.columns = {{"", "parameter", "", true}, {"", "unit", "", true}, {"", "CAD", ""},
                   {"", "value", ""},           {"", "sd", ""},         {"", "rsd %", ""}};
  add_parameter_rows(result, result.parameters, notes, table);
  if (is_alone) add_parameter_rows(result, result.preloads.front().parameters, notes, table);
  table.notes = notes.lines();
  note_profiles(result.parameters, table);
  return table;
}

const Estimate* elongation_estimate(const IdentifyPreload& preload, const Cable& cable) {
  return find_estimate(preload.parameters, elongation_name(cable));
}

std::string interval_text(const Estimate& e) {
  const auto end = [&](double value) {
    return std::isnan(value) ? std::string("?") : value_text(kMilli * value, kMilli * e.sd);
  };
  return end(e.ci_low) + " .. " + end(e.ci_high);
}

/// Intervals of l_o are then those of the joint covariance.
bool searches_radius(const IdentifyResult& result) {
  return std::any_of(result.parameters.begin(), result.parameters.end(),
                     [](const Estimate& e) { return e.name.starts_with("r_m["); });
}

/// l_o of every cable: found, or as given.
Table elongation_table(const IdentifyResult& result) {
  Table table;
  Footnotes notes;
  const std::string length = result.cable_space ? "mm" : unit_for(result.axes, "mrad");
  table.title = "Initial elongations l_o";
  table.columns = {{"", "preload", "", true},
                   {"", "cable", "", true},
                   {"", "l_o", length},
                   {"", "sd", length},
                   {"", "95 % interval", searches_radius(result) ? "" : "profile likelihood"},
                   {"", "tension", result.cable_space ? "N" : torque_unit(result.axes)}};
  for (const IdentifyPreload& preload : result.preloads)
    for (const Cable& cable : preload.transmission.cables) {
      const Estimate* e = elongation_estimate(preload, cable);
      const double l = cable.initial_elongation;
      std::vector<std::string> row = {preload.name, cable.name};
      if (e == nullptr) {
        row.insert(row.end(), {fmt::format("{:g}", kMilli * l), "given", kNoNumber});
      } else if (!e->not_identifiable.empty()) {
        row.insert(row.end(), {"not identifiable", notes.mark(e->not_identifiable), kNoNumber});
      } else {
        row.insert(row.end(), {value_text(kMilli * l, kMilli * e->sd),
                               sd_text(kMilli * l, kMilli * e->sd), interval_text(*e)});
      }
      row.push_back(e != nullptr && !e->not_identifiable.empty()
                        ? kNoNumber
                        : significant(cable.force(l), kDigits));
      table.rows.push_back(row);
    }
  table.notes = notes.lines();
  double most = 0;
  for (const IdentifyPreload& preload : result.preloads) most = std::max(most, preload.equilibrium);
  table.notes.push_back(fmt::format(
      "in the reference pose the preload alone gives {} {} on link and motor: "
      "equilibrium (8c), imposed",
      most < kEquilibriumMet ? "less than 1e-9" : significant(most, 2), torque_unit(result.axes)));
  return table;
}

/// The summary has those that were found; the table says why one was not.
bool any_open_elongation(const IdentifyResult& result) {
  return std::any_of(
      result.preloads.begin(), result.preloads.end(), [](const IdentifyPreload& preload) {
        return std::any_of(
            preload.parameters.begin(), preload.parameters.end(),
            [](const Estimate& e) { return is_elongation(e) && !e.not_identifiable.empty(); });
      });
}

bool any_load(const IdentifyResult& result) {
  return std::any_of(result.preloads.begin(), result.preloads.end(),
                     [](const IdentifyPreload& preload) { return preload.load_inertia > 0; });
}

void add_net_row(const IdentifyResult& result, const Estimate& row, Table& table) {
  std::vector<std::string> cells = {"  without the load", row.unit, kNoNumber};
  for (const IdentifyPreload& preload : result.preloads) {
    const EstimateCells c =
        cells_without_load(find_estimate(preload.parameters, row.name), preload.load_inertia);
    cells.insert(cells.end(), {c.value, c.rsd});
  }
  table.rows.push_back(cells);
}

/// Table 2, a column per preload.
Table dynamics_table(const IdentifyResult& result) {
  Table table;
  Footnotes notes;
  table.title = "Each preload's own (Table 2)";
  table.columns = {{"", "parameter", "", true}, {"", "unit", "", true}, {"", "CAD", ""}};
  std::vector<const Estimate*> rows;
  for (const IdentifyPreload& preload : result.preloads) {
    table.columns.push_back({preload.name, "value", ""});
    table.columns.push_back({preload.name, "rsd %", ""});
    for (const Estimate& e : preload.parameters)
      if (!is_elongation(e) && std::none_of(rows.begin(), rows.end(), [&](const Estimate* other) {
            return other->name == e.name;
          }))
        rows.push_back(&e);
  }
  for (const Estimate* row : rows) {
    std::vector<std::string> cells = {label(*row), row->unit, cad_text(*row)};
    for (const IdentifyPreload& preload : result.preloads) {
      const EstimateCells c = cells_of(find_estimate(preload.parameters, row->name), notes);
      cells.insert(cells.end(), {c.value, c.rsd});
    }
    table.rows.push_back(cells);
    if (row->name == "J_link" && any_load(result)) add_net_row(result, *row, table);
  }
  table.notes = notes.lines();
  return table;
}

/// The linear model's K on the range of each preload.
Table line_table(const IdentifyResult& result) {
  Table table;
  table.title = "Linear stiffness K: the straight line through the blocked rows";
  table.columns = {{"", "preload", "", true},
                   {"", "slope", "", true},
                   {"", "deflection", unit_for(result.axes, "mrad")},
                   {"", "measured", unit_for(result.axes, "N m/rad")},
                   {"", "of these cables", unit_for(result.axes, "N m/rad")}};
  for (const IdentifyPreload& preload : result.preloads)
    for (const LineStiffness& line : preload.lines)
      table.rows.push_back({preload.name, line.name, milli_range(line.low, line.high),
                            value_with_sd(line.measured, line.sd),
                            value_text(line.model, line.sd)});
  return table;
}

Table slack_table(const IdentifyResult& result) {
  Table table;
  table.title = "Cables go slack (force disclosure) at";
  table.columns = {{"", "preload", "", true},
                   {"", "cable", "", true},
                   {"", "deflection", unit_for(result.axes, "mrad")},
                   {"", "elastic torque", torque_unit(result.axes)},
                   {"", "slack", "", true}};
  for (const IdentifyPreload& preload : result.preloads)
    for (const SlackPoint& point : preload.slack)
      table.rows.push_back({preload.name, preload.transmission.cables[point.cable].name,
                            significant(kMilli * point.deflection, kDigits),
                            significant(point.motor, kDigits),
                            point.slack_above ? "above" : "below"});
  return table;
}

Table equation_table(const IdentifyResult& result) {
  Table table;
  table.title = "Equations: residual and weight of each";
  table.columns = {
      {"", "preload", "", true}, {"", "equation", "", true},  {"", "rms", torque_unit(result.axes)},
      {"rows", "used", ""},      {"rows", "at rest", ""},     {"rows", "not used", ""},
      {"rows", "effective", ""}, {"", "weight", "1/variance"}};
  for (const IdentifyPreload& preload : result.preloads)
    for (const IdentifyEquation& e : preload.equations)
      table.rows.push_back(
          {preload.name, e.name, significant(e.rms, kDigits), std::to_string(e.counts.rows_used),
           std::to_string(e.counts.rows_at_rest), std::to_string(e.counts.rows_not_used),
           fmt::format("{:.0f}", e.effective_rows), significant(e.weight, kDigits)});
  return table;
}

Table sd_table(const IdentifyResult& result) {
  Table table = both_sd_table({"preload"});
  add_sd_rows(table, {"all"}, result.parameters);
  for (const IdentifyPreload& preload : result.preloads)
    add_sd_rows(table, {preload.name}, preload.parameters);
  return table;
}

void add_tidy_rows(Document& document, const std::string& preload,
                   const std::vector<Estimate>& parameters) {
  for (const Estimate& e : parameters) add_tidy(document.tidy, preload, "poly", "joint", e);
}

/// "residual: blocked 0.0549 N m rms, link ..."; of several joints the least and the largest.
std::string residual_text(const IdentifyPreload& preload, Axes axes) {
  std::string text;
  for (const char* side : {"blocked", "link", "motor"}) {
    double least = kUnbounded, most = -kUnbounded;
    for (const IdentifyEquation& e : preload.equations) {
      if (e.side != side) continue;
      least = std::min(least, e.rms);
      most = std::max(most, e.rms);
    }
    if (most < least) continue;
    const std::string from = significant(least, kDigits), to = significant(most, kDigits);
    text += fmt::format("{} {} {} {} rms", text.empty() ? "residual:" : ",", side,
                        from == to ? to : from + " .. " + to, torque_unit(axes));
  }
  return text;
}

/// "J_link", or "J_link[1..3]" of several joints.
std::string name_of_all(const IdentifyResult& result, const char* name) {
  const int n = result.preloads.front().transmission.n_joints;
  return n > 1 ? fmt::format("{}[1..{}]", name, n) : name;
}

Headline headline_of(const IdentifyResult& result) {
  Headline headline;
  std::size_t n = 0, n_missing = 0;
  const auto count = [&](const std::vector<Estimate>& all) {
    n += all.size();
    for (const Estimate& e : all) n_missing += e.not_identifiable.empty() ? 0 : 1;
  };
  count(result.parameters);
  for (const IdentifyPreload& preload : result.preloads) count(preload.parameters);
  headline.word = n_missing == 0 ? "identified" : "partly identified";
  headline.tone = n_missing == 0 ? Tone::good : Tone::neutral;
  headline.verdict = fmt::format("{} of {} parameters identified", n - n_missing, n);
  for (const char* name : {"J_link", "J_motor"}) {
    std::vector<NamedNumber> values;
    std::string unit;
    const auto add = [&](const std::vector<Estimate>& all, const std::string& whose) {
      for (const Estimate& e : all) {
        const bool is_it = e.name == name || e.name.starts_with(std::string(name) + "[");
        if (!is_it || !e.not_identifiable.empty()) continue;
        values.push_back({whose, headline_value(e)});
        unit = e.unit;
      }
    };
    add(result.parameters, "");
    for (const IdentifyPreload& preload : result.preloads) add(preload.parameters, preload.name);
    if (!values.empty())
      headline.numbers.push_back({name_of_all(result, name), joined_numbers(values) + " " + unit});
  }
  std::vector<NamedNumber> residuals;
  for (const IdentifyPreload& preload : result.preloads)
    for (const IdentifyEquation& e : preload.equations)
      if (e.side == "motor") residuals.push_back({preload.name, significant(e.rms, kDigits)});
  if (!residuals.empty())
    headline.numbers.push_back(
        {"residual, motor equation",
         fmt::format("{} {} rms", joined_numbers(residuals), torque_unit(result.axes))});
  return headline;
}

}  // namespace

Document identify_document(const IdentifyResult& result) {
  Document document;
  document.title = "One step: elastic and dynamic parameters of all preloads together";
  document.tidy = tidy_table();
  add_warnings(document, "", result.warnings);
  add_tidy_rows(document, "all", result.parameters);
  Table derived = derived_table();
  for (const IdentifyPreload& preload : result.preloads) {
    document.summary.push_back({preload.name, residual_text(preload, result.axes)});
    const std::string elongations = elongations_text(preload.parameters);
    if (!elongations.empty()) document.summary.push_back({"", elongations});
    add_decisions(document, preload.name, preload.decisions);
    add_decisions(document, preload.name, result.decisions);
    add_warnings(document, preload.name, preload.warnings);
    add_tidy_rows(document, preload.name, preload.parameters);
    add_tidy_rows(document, preload.name, preload.derived);
    add_derived(derived, preload.name, preload.derived);
  }
  add_figures(document, result.figures);
  finish_decisions(document, result.preloads.size());
  document.headline = headline_of(result);
  lead_with(document, 1);
  for (const std::string& bound : result.active_bounds)
    document.paragraphs.push_back("held by its bound: " + bound);
  add_table(document, shared_table(result));
  if (result.preloads.size() > 1) add_table(document, dynamics_table(result));
  if (any_open_elongation(result))
    add_table(document, elongation_table(result));
  else
    add_detail(document, elongation_table(result));
  for (Table& table : std::vector<Table>{line_table(result), slack_table(result), derived,
                                         equation_table(result), sd_table(result)})
    add_detail(document, std::move(table));
  return document;
}

}  // namespace cablefit
