// A document for the terminal.
#include "cablefit/report/escape.hpp"
#include "cablefit/report/text_table.hpp"
#include "cablefit/report/writers.hpp"

namespace cablefit {
namespace {

std::string decision_text(const DecisionLine& line) {
  std::string text = "  " + printable(where_text(line) + line.name + " = " + line.value);
  if (!line.reason.empty()) text += printable(" (" + line.reason + ")");
  return text + "\n";
}

}  // namespace

std::string write_text(const Document& document) {
  std::string text;
  const auto begin_block = [&text] {
    if (!text.empty()) text += "\n";
  };
  if (!document.title.empty()) text += printable(document.title) + "\n";
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
