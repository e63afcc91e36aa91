#include "cablefit/report/writers/wrap.hpp"

#include <algorithm>

#include "cablefit/report/parts/escape.hpp"

namespace cablefit {
namespace {

/// Bytes of the first `n` characters.
std::size_t bytes_of(std::string_view text, std::size_t n) {
  std::size_t at = 0;
  for (; at < text.size(); ++at)
    if (!is_continuation(text[at]) && n-- == 0) break;
  return at;
}

/// What of a word that is too long stands on one line.
std::size_t cut_of(std::string_view word, std::size_t width) {
  const std::size_t whole = bytes_of(word, width);
  const std::size_t slash = word.substr(0, whole).rfind('/');
  return slash == std::string_view::npos || slash == 0 ? whole : slash + 1;
}

constexpr char kGlue = '\x01';  // a blank that does not break; no printable text has it

/// A number and its unit stay on one line.
std::string glued(std::string_view text) {
  std::string out(text);
  for (const std::string_view unit : {" %", " N m"})
    for (std::size_t at = out.find(unit); at != std::string::npos; at = out.find(unit, at + 1))
      std::replace(out.begin() + static_cast<std::ptrdiff_t>(at),
                   out.begin() + static_cast<std::ptrdiff_t>(at + unit.size()), ' ', kGlue);
  return out;
}

}  // namespace

std::vector<std::string> wrapped_lines(std::string_view given, std::size_t width) {
  width = std::max<std::size_t>(width, 1);
  const std::string glued_text = glued(given);
  const std::string_view text = glued_text;
  std::vector<std::string> lines = {""};
  std::size_t used = 0;
  const auto begin_line = [&] {
    lines.emplace_back();
    used = 0;
  };
  const auto add = [&](std::string_view piece) {
    if (used > 0) lines.back() += ' ';
    lines.back() += piece;
    used += n_characters(piece) + (used > 0 ? 1 : 0);
  };
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    std::string_view word = text.substr(at, end - at);
    at = end + 1;
    if (word.empty()) continue;
    if (used > 0 && used + 1 + n_characters(word) > width) begin_line();
    for (; n_characters(word) > width; begin_line()) {
      const std::size_t cut = cut_of(word, width);
      add(word.substr(0, cut));
      word.remove_prefix(cut);
    }
    add(word);
  }
  for (std::string& line : lines) std::replace(line.begin(), line.end(), kGlue, ' ');
  return lines;
}

std::string wrapped(std::string_view first, std::string_view text, std::size_t margin) {
  constexpr std::size_t kWidestMargin = kTextWidth / 2;
  margin = std::min(margin, kWidestMargin);
  std::string out(first);
  bool begins = true;
  for (const std::string& line : wrapped_lines(text, kTextWidth - margin)) {
    if (!begins) out += std::string(margin, ' ');
    begins = false;
    out += line + "\n";
  }
  return out;
}

}  // namespace cablefit
