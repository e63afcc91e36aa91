// A document for the terminal.
#include <algorithm>

#include "cablefit/report/documents/escape.hpp"
#include "cablefit/report/writers/text_table.hpp"
#include "cablefit/report/writers/writers.hpp"

namespace cablefit {
namespace {

std::string decision_text(const DecisionLine& line) {
  std::string text = "  " + printable(where_text(line) + line.name + " = " + line.value);
  if (!line.reason.empty()) text += printable(" (" + line.reason + ")");
  return text + "\n";
}

/// `text` in lines of at most `width` characters, all but the first behind `margin`.
std::string wrapped(const std::string& text, std::size_t width, const std::string& margin) {
  std::string lines;
  std::size_t used = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (used > 0 && used + 1 + word.size() > width) {
      lines += "\n" + margin;
      used = 0;
    }
    if (used > 0) lines += " ";
    lines += word;
    used += word.size() + (used > 0 ? 1 : 0);
    at = end + 1;
  }
  return lines;
}

/// Labels in one column, texts beside them.
std::string summary_text(const std::vector<SummaryLine>& summary) {
  std::size_t width = 0;
  for (const SummaryLine& line : summary) width = std::max(width, line.label.size());
  const std::string margin(width + 2, ' ');
  std::string text;
  for (const SummaryLine& line : summary) {
    const std::string label = printable(line.label);
    text += label + margin.substr(std::min(margin.size(), label.size())) +
            wrapped(printable(line.text), kTextWidth - margin.size(), margin) + "\n";
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
    text += printable(paragraph) + "\n";
  }
  if (!document.decisions.empty()) {
    begin_block();
    text += "Choices\n";
    for (const DecisionLine& line : document.decisions) text += decision_text(line);
  }
  if (!document.warnings.empty()) begin_block();
  for (const std::string& warning : document.warnings) {
    text += "warning: " + printable(warning) + "\n";
  }
  return text;
}

}  // namespace cablefit
