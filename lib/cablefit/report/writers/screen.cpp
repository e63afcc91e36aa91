#include "cablefit/report/writers/screen.hpp"

#include <fmt/format.h>

#include <utility>

namespace cablefit {
namespace {

constexpr std::size_t kMostWarnings = 3;

/// Files that were taken though nobody named them.
bool is_about_input(const DecisionLine& line) {
  return line.name == "logs" || line.name == "blocked logs" || line.name == "stage 1";
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
  const std::size_t n = document.warnings.size();
  if (n <= kMostWarnings + 1) return document;
  document.warnings.resize(kMostWarnings);
  document.warnings.push_back(
      fmt::format("{} more warnings: see them with --verbose", n - kMostWarnings));
  return document;
}

}  // namespace cablefit
