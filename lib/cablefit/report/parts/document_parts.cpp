#include "cablefit/report/parts/document_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/report/parts/figure_units.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

std::string count(std::size_t n) { return fmt::format("{}", n); }

bool same_decision(const DecisionLine& line, const Decision& decision) {
  return line.name == decision.name && line.value == decision.value &&
         line.reason == decision.reason;
}

}  // namespace

std::string Footnotes::mark(const std::string& text) {
  auto found = std::find(texts_.begin(), texts_.end(), text);
  if (found == texts_.end()) found = texts_.insert(found, text);
  return fmt::format("[{}]", found - texts_.begin() + 1);
}

std::vector<std::string> Footnotes::lines() const {
  std::vector<std::string> lines;
  for (const std::string& text : texts_) {
    lines.push_back(fmt::format("[{}] {}", lines.size() + 1, text));
  }
  return lines;
}

void add_decisions(Document& document, const std::string& preload,
                   const std::vector<Decision>& decisions) {
  auto& lines = document.decisions;
  for (const Decision& decision : decisions) {
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const DecisionLine& line) {
      return same_decision(line, decision);
    });
    if (same != lines.end()) {
      same->where.push_back(preload);
      continue;
    }
    // Behind the last one of its name, so that preloads can be compared.
    const auto last = std::find_if(lines.rbegin(), lines.rend(), [&](const DecisionLine& line) {
      return line.name == decision.name;
    });
    lines.insert(last == lines.rend() ? lines.end() : last.base(),
                 {{preload}, decision.name, decision.value, decision.reason});
  }
}

void finish_decisions(Document& document, std::size_t n_preloads) {
  for (DecisionLine& line : document.decisions) {
    if (line.where.size() >= n_preloads) line.where.clear();
  }
}

void add_warnings(Document& document, const std::string& where,
                  const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    document.warnings.push_back(where.empty() ? warning : where + ": " + warning);
  }
}

void add_table(Document& document, Table table) {
  if (!table.rows.empty()) document.tables.push_back(std::move(table));
}

void add_detail(Document& document, Table table) {
  table.detail = true;
  add_table(document, std::move(table));
}

void add_figures(Document& document, const std::vector<Figure>& figures) {
  for (const Figure& figure : figures) document.figures.push_back(in_table_units(figure));
}

void lead_with(Document& document, std::size_t n) {
  const auto is_main = [](const Figure& figure) { return figure.rank == FigureRank::main; };
  const bool none = std::none_of(document.figures.begin(), document.figures.end(), is_main);
  for (Figure& figure : document.figures) {
    if (!none && !is_main(figure)) continue;
    if (n > 0)
      figure.rank = FigureRank::main;
    else if (is_main(figure))
      figure.rank = FigureRank::shown;
    n -= n > 0 ? 1 : 0;
  }
}

std::string joined_numbers(const std::vector<NamedNumber>& numbers) {
  constexpr std::size_t kFew = 2;
  if (numbers.size() == 1) return numbers.front().number;
  const auto text = [](const NamedNumber& n) {
    return n.name.empty() ? n.number : fmt::format("{} ({})", n.number, n.name);
  };
  return text(numbers.front()) + (numbers.size() > kFew ? " ... " : " / ") + text(numbers.back());
}

std::string elongations_text(const std::vector<Estimate>& parameters) {
  std::string text;
  for (const Estimate& e : parameters)
    if (e.name.starts_with("l_o[") && e.not_identifiable.empty())
      text += fmt::format("{}{} = {} m{}", text.empty() ? "" : ", ", e.name,
                          value_with_sd(1e3 * e.value, 1e3 * e.sd), e.unit);
  return text;
}

std::string headline_value(const Estimate& e) {
  constexpr double kFourDigits = 1e-2;  // sd of a value with them, see value_text
  return value_text(e.value, std::max(e.sd, kFourDigits * std::abs(e.value)));
}

void append(Document& all, const Document& part) {
  all.tables.insert(all.tables.end(), part.tables.begin(), part.tables.end());
  all.paragraphs.insert(all.paragraphs.end(), part.paragraphs.begin(), part.paragraphs.end());
  all.decisions.insert(all.decisions.end(), part.decisions.begin(), part.decisions.end());
  add_figures(all, part.figures);
  all.warnings.insert(all.warnings.end(), part.warnings.begin(), part.warnings.end());
  if (all.tidy.columns.empty()) {
    all.tidy = part.tidy;
  } else {
    all.tidy.rows.insert(all.tidy.rows.end(), part.tidy.rows.begin(), part.tidy.rows.end());
  }
}

Table counts_table() {
  Table table;
  table.title = "Rows";
  table.columns = {{"", "preload", "", true},           {"", "equation", "", true},
                   {"of the log", "read", ""},          {"of the log", "resampled", ""},
                   {"of the log", "too short", ""},     {"of the log", "at edges", ""},
                   {"after decimation", "at rest", ""}, {"after decimation", "not used", ""},
                   {"after decimation", "used", ""}};
  return table;
}

void add_counts(Table& table, const std::string& preload, const std::string& equation,
                const RowCounts& rows, const WindowCounts& windows) {
  table.rows.push_back({preload, equation, count(windows.rows_read), count(windows.rows_resampled),
                        count(windows.rows_too_short), count(rows.rows_at_edges),
                        count(rows.rows_at_rest), count(rows.rows_not_used),
                        count(rows.rows_used)});
}

Table tidy_table() {
  Table table;
  for (const char* name :
       {"preload", "model", "method", "parameter", "symbol", "unit", "value", "sd", "rsd_percent",
        "sd_white", "ci95_low", "ci95_high", "cad", "not_identifiable", "active_bound"}) {
    table.columns.push_back({"", name, ""});
  }
  return table;
}

void add_tidy(Table& table, const std::string& preload, const std::string& model,
              const std::string& method, const Estimate& e) {
  const bool known = e.not_identifiable.empty();
  const auto if_known = [known](double value) { return known ? exact(value) : ""; };
  table.rows.push_back({preload, model, method, e.name, e.symbol, e.unit, exact(e.value),
                        if_known(e.sd), if_known(e.rsd_percent()), if_known(e.sd_white),
                        if_known(e.ci_low), if_known(e.ci_high), exact(e.cad), e.not_identifiable,
                        e.active_bound});
}

void add_tidy_number(Table& table, const std::string& preload, const std::string& model,
                     const std::string& method, const std::string& name, const std::string& unit,
                     double value) {
  table.rows.push_back(
      {preload, model, method, name, "", unit, exact(value), "", "", "", "", "", "", "", ""});
}

Table both_sd_table(const std::vector<std::string>& where) {
  Table table;
  table.title = "Robust standard deviations, and the white-noise ones of (25)";
  for (const std::string& title : where) table.columns.push_back({"", title, "", true});
  const std::vector<Column> own = {{"", "parameter", "", true}, {"", "unit", "", true},
                                   {"", "value", ""},           {"", "sd", ""},
                                   {"", "sd of (25)", ""},      {"95 % interval", "from", ""},
                                   {"95 % interval", "to", ""}};
  table.columns.insert(table.columns.end(), own.begin(), own.end());
  return table;
}

void add_sd_rows(Table& table, const std::vector<std::string>& where,
                 const std::vector<Estimate>& parameters) {
  for (const Estimate& e : parameters) {
    if (!e.not_identifiable.empty()) continue;
    std::vector<std::string>& row = table.rows.emplace_back(where);
    for (std::string cell :
         {e.name, e.unit, value_text(e.value, e.sd), sd_text(e.value, e.sd),
          significant(e.sd_white, 2), value_text(e.ci_low, e.sd), value_text(e.ci_high, e.sd)})
      row.push_back(std::move(cell));
  }
}

Table derived_table() {
  Table table;
  table.title = "Derived quantities";
  table.columns = {{"", "fit", "", true},      {"", "quantity", "", true},
                   {"", "unit", "", true},     {"", "value", ""},
                   {"", "sd", "delta method"}, {"95 % interval", "from", ""},
                   {"95 % interval", "to", ""}};
  return table;
}

namespace {

/// "f_0 (free resonance at rest)": symbols of different papers mean different resonances.
std::string quantity_text(const std::string& name) {
  if (name == "K_rest") return name + " (stiffness at rest)";
  if (name == "f_0") return name + " (free resonance at rest)";
  if (name == "zeta") return name + " (its damping ratio)";
  return name;
}

}  // namespace

void add_derived(Table& table, const std::string& where, const std::vector<Estimate>& derived) {
  for (const Estimate& e : derived)
    table.rows.push_back({where, quantity_text(e.name), e.unit, value_text(e.value, e.sd),
                          sd_text(e.value, e.sd), value_text(e.ci_low, e.sd),
                          value_text(e.ci_high, e.sd)});
}

}  // namespace cablefit
