// A document for the terminal.
#include <algorithm>

#include "cablefit/report/parts/escape.hpp"
#include "cablefit/report/writers/text_table.hpp"
#include "cablefit/report/writers/wrap.hpp"
#include "cablefit/report/writers/writers.hpp"

namespace cablefit {
namespace {

std::string decision_lines(const DecisionLine& line) {
  std::string text = where_text(line) + line.name + " = " + line.value;
  if (!line.reason.empty()) text += " (" + line.reason + ")";
  return wrapped("  ", printable(text), 4);
}

/// Labels in one column, texts beside them; a long label has a line of its own.
std::string summary_text(const std::vector<SummaryLine>& summary) {
  constexpr std::size_t kLongLabel = 24;
  std::size_t width = 0;
  for (const SummaryLine& line : summary) {
    const std::size_t n = n_characters(printable(line.label));
    if (n <= kLongLabel) width = std::max(width, n);
  }
  std::string text;
  for (const SummaryLine& line : summary) {
    std::string label = printable(line.label);
    const std::size_t n = n_characters(label);
    label += n > width ? "\n" + std::string(width + 2, ' ') : std::string(width + 2 - n, ' ');
    text += wrapped(label, printable(line.text), width + 2);
  }
  return text;
}

}  // namespace

std::string write_text(const Document& document) {
  std::string text;
  const auto begin_block = [&text] {
    if (!text.empty()) text += "\n";
  };
  if (!document.title.empty()) text += printable(document.title) + "\n";
  if (!document.summary.empty()) begin_block();
  text += summary_text(document.summary);
  for (const Table& table : document.tables) {
    begin_block();
    text += text_table(table);
  }
  if (!document.paragraphs.empty()) begin_block();
  for (const std::string& paragraph : document.paragraphs) {
    text += wrapped("", printable(paragraph), 0);
  }
  if (!document.decisions.empty()) {
    begin_block();
    text += "Choices\n";
    for (const DecisionLine& line : document.decisions) text += decision_lines(line);
  }
  if (!document.warnings.empty()) begin_block();
  for (const std::string& warning : document.warnings) {
    text += wrapped("", "warning: " + printable(warning), 2);
  }
  return text;
}

}  // namespace cablefit
