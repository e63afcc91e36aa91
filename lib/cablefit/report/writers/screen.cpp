#include "cablefit/report/writers/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "cablefit/report/writers/writers.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMostWarnings = 3, kFewWarnings = 1;  // few: of long answers
constexpr auto kMostLines = 37;                             // of 40: three name the files

/// Files that were taken though nobody named them.
bool is_about_input(const DecisionLine& line) {
  return line.name == "logs" || line.name == "blocked logs" || line.name == "stage 1";
}

auto n_lines(const Document& document) {
  const std::string text = write_text(document);
  return std::count(text.begin(), text.end(), '\n');
}

void keep_warnings(std::size_t most, Document& document) {
  const std::size_t n = document.warnings.size();
  if (n <= most + 1) return;
  document.warnings.resize(most);
  document.warnings.push_back(fmt::format("{} more warnings: see them with --verbose", n - most));
}

}  // namespace

Document on_screen(Document document) {
  document = without_details(std::move(document));
  document.paragraphs.clear();
  for (const DecisionLine& line : document.decisions)
    if (is_about_input(line))
      document.summary.push_back(
          {line.name, fmt::format("{}{} ({})", where_text(line), line.value, line.reason)});
  document.decisions.clear();
  const std::vector<std::string> all = document.warnings;
  keep_warnings(kMostWarnings, document);
  if (n_lines(document) <= kMostLines) return document;
  std::erase_if(document.tables, std::mem_fn(&Table::is_optional));
  if (n_lines(document) <= kMostLines) return document;
  document.warnings = all;
  keep_warnings(kFewWarnings, document);
  return document;
}

}  // namespace cablefit
