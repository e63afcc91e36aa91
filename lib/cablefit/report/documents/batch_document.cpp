#include "cablefit/report/documents/batch_document.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"
#include "cablefit/report/sections/batch_figures.hpp"
#include "cablefit/report/sections/preload_report.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostCellsInFull = 12;
constexpr const char* kFailed = "FAILED";

template <class Items, class Is>
std::size_t n_with(const Items& items, Is is) {
  return static_cast<std::size_t>(std::count_if(items.begin(), items.end(), is));
}

/// "all 3 cells fitted", "1 cell fitted".
std::string all_of(std::size_t n, const char* what, const char* how) {
  return n == 1 ? fmt::format("1 {} {}", what, how) : fmt::format("all {} {}s {}", n, what, how);
}

/// What a reader in a hurry wants: how much was done, and everything that failed.
std::vector<SummaryLine> summary_of(const BatchResult& result) {
  const std::size_t n_failed =
      n_with(result.cells, [](const BatchCell& cell) { return !cell.error.empty(); });
  std::vector<SummaryLine> lines = {
      {"Cells", fmt::format("{} fitted, {} failed", result.cells.size() - n_failed, n_failed)}};
  for (const BatchCell& cell : result.cells)
    if (!cell.error.empty()) lines.push_back({kFailed, cell.name + ": " + cell.error});
  if (result.gates.empty()) return lines;
  lines.push_back(
      {"Gates", fmt::format("{} checked, {} failed", result.gates.size(),
                            n_with(result.gates, [](const Gate& gate) { return !gate.passed; }))});
  for (const Gate& gate : result.gates)
    if (!gate.passed && gate.name != kFittedGate)
      lines.push_back({kFailed, gate.text.substr(gate.text.find(' ') + 1)});
  return lines;
}

Table gate_table(const BatchResult& result) {
  Table table;
  table.title = "Gates";
  table.columns = {{"", "cell", "", true},
                   {"", "gate", "", true},
                   {"", "limit", "", false},
                   {"", "value", "", false},
                   {"", "", "", true, true}};
  for (const Gate& gate : result.gates)
    table.rows.push_back({gate.cell, gate.name, fmt::format("{:.4g}", gate.limit),
                          fmt::format("{:.4g}", gate.value), gate.passed ? "passed" : "FAILED"});
  table.detail = true;
  return table;
}

std::string effects_text(const CellRefine& refine) {
  std::string text;
  for (const CellEffect& effect : refine.effects)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", effect.name, effect.side);
  return text.empty() ? kNoNumber : text;
}

std::string unit_of(const BatchResult& result) {
  for (const BatchCell& cell : result.cells)
    if (cell.dynamic) return torque_unit(cell.dynamic->preloads.front().axes);
  return torque_unit(Axes::rotary);
}

/// The missing effects of every cell that was refined; no rows where none was.
Table refine_table(const BatchResult& result) {
  Table table;
  table.title = "Missing effects";
  table.columns = {{"", "cell", "", true},
                   {"", "verdict", "", true},
                   {"", "effects", "", true},
                   {"torque gap, test", "before", unit_of(result)},
                   {"torque gap, test", "after", unit_of(result)},
                   {"torque gap, test", "floor", unit_of(result)}};
  for (const BatchCell& cell : result.cells) {
    if (!cell.refine) continue;
    const CellRefine& refine = *cell.refine;
    const auto gap = [&](double value) {
      return refine.torque.known ? significant(value, kDigits) : kNoNumber;
    };
    table.rows.push_back({cell.name, refine.error.empty() ? refine.verdict : "none possible",
                          effects_text(refine), gap(refine.torque.test_before),
                          gap(refine.torque.test_after), gap(refine.torque.noise_floor)});
    table.notes.push_back(cell.name + ": " + (refine.error.empty() ? refine.reason : refine.error));
  }
  return table;
}

/// Whether everything passed, before anything else.
Headline headline_of(const BatchResult& result, const Headline& dynamic) {
  const auto failed =
      n_with(result.cells, [](const BatchCell& cell) { return !cell.error.empty(); });
  const auto closed = n_with(result.gates, [](const Gate& gate) { return !gate.passed; });
  const std::size_t n_cells = result.cells.size(), n_gates = result.gates.size();
  const bool is_bad = failed > 0 || closed > 0;
  Headline headline;
  headline.word = is_bad ? kFailed : n_gates > 0 ? "passed" : "fitted";
  headline.tone = is_bad ? Tone::bad : Tone::good;
  const auto add = [&headline](const std::string& text) {
    headline.verdict += (headline.verdict.empty() ? "" : ", ") + text;
  };
  if (failed > 0) add(fmt::format("{} of {} cells failed", failed, n_cells));
  if (closed > 0) add(fmt::format("{} of {} gates failed", closed, n_gates));
  if (!is_bad) add(all_of(n_cells, "cell", "fitted"));
  if (!is_bad && n_gates > 0) add(all_of(n_gates, "gate", "passed"));
  headline.numbers = {{"cells fitted", fmt::format("{} of {}", n_cells - failed, n_cells)}};
  if (n_gates > 0)
    headline.numbers.push_back(
        {"gates passed", fmt::format("{} of {}", n_gates - closed, n_gates)});
  if (!dynamic.numbers.empty()) headline.numbers.push_back(dynamic.numbers.front());
  return headline;
}

/// Of many cells what people read; GitHub takes a summary of 1 MB.
Document in_short(Document document) {
  document = without_details(std::move(document));
  document.decisions.clear();
  document.paragraphs = {
      "Choices with their reasons, rows used and the paper's sd of every cell are in batch.json."};
  return document;
}

}  // namespace

Document batch_document(const BatchResult& result) {
  Document document;
  document.title = result.campaign_name.empty() ? "Campaign" : result.campaign_name;
  document.summary = summary_of(result);
  document.warnings = result.warnings;
  document.figures = parameter_figures(result);
  append(document, elastic_document(result.all_elastic()));
  for (Table& table : document.tables) table.detail = true;  // what the advice rests on
  const Document dynamic = dynamic_document(result.all_dynamic());
  append(document, dynamic);
  document.headline = headline_of(result, dynamic.headline);
  if (Table refine = refine_table(result); !refine.rows.empty())
    document.tables.push_back(std::move(refine));
  add_preload_advice(result, document);
  if (!result.gates.empty()) document.tables.push_back(gate_table(result));
  lead_with(document, 1);
  return result.cells.size() > kMostCellsInFull ? in_short(std::move(document)) : document;
}

}  // namespace cablefit
