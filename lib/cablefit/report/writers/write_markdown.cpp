// A document as Markdown (GitHub's tables).
#include "cablefit/report/parts/escape.hpp"
#include "cablefit/report/writers/writers.hpp"

namespace cablefit {
namespace {

std::string row_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

std::string markdown_header_cell(const Column& column) {
  std::string text = column.group.empty() ? "" : column.group + ": ";
  text += column.title;
  if (!column.unit.empty()) text += " [" + column.unit + "]";
  return markdown_text(text);
}

std::string table_text(const Table& table) {
  std::string text = table.title.empty() ? "" : "## " + markdown_text(table.title) + "\n\n";
  std::vector<std::string> titles, rules;
  for (const Column& column : table.columns) {
    titles.push_back(markdown_header_cell(column));
    rules.emplace_back(column.is_text ? "---" : "---:");
  }
  text += row_of(titles) + row_of(rules);
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const std::string& cell : row) cells.push_back(markdown_text(cell));
    text += row_of(cells);
  }
  text += "\n";
  for (const std::string& note : table.notes) text += markdown_text(note) + "\n\n";
  return text;
}

std::string decision_text(const DecisionLine& line) {
  std::string text = where_text(line) + line.name + " = " + line.value;
  if (!line.reason.empty()) text += " (" + line.reason + ")";
  return "- " + markdown_text(text) + "\n";
}

}  // namespace

std::string write_markdown(const Document& document) {
  std::string text = "# " + markdown_text(document.title) + "\n\n";
  for (const SummaryLine& line : document.summary)
    text += line.label.empty()  // goes on with the line before
                ? "  " + markdown_text(line.text) + "\n"
                : "- **" + markdown_text(line.label) + "**: " + markdown_text(line.text) + "\n";
  if (!document.summary.empty()) text += "\n";
  for (const Table& table : document.tables) text += table_text(table);
  for (const std::string& paragraph : document.paragraphs)
    text += markdown_text(paragraph) + "\n\n";
  if (!document.decisions.empty()) text += "## Choices\n\n";
  for (const DecisionLine& line : document.decisions) text += decision_text(line);
  if (!document.decisions.empty()) text += "\n";
  if (!document.warnings.empty()) text += "## Warnings\n\n";
  for (const std::string& warning : document.warnings) text += "- " + markdown_text(warning) + "\n";
  return text;
}

}  // namespace cablefit
