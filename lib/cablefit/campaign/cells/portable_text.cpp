#include "cablefit/campaign/cells/portable_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>

#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

constexpr char kMark = '\x01';

/// Of a longer path than the one looked for.
bool goes_on(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '/';
}

bool stands_alone(const std::string& text, std::size_t at, std::size_t length) {
  const std::size_t end = at + length;
  if (at > 0 && (goes_on(text[at - 1]) || text[at - 1] == '.')) return false;
  return end == text.size() || !goes_on(text[end]);
}

void replace_all(std::string& text, const std::string& path, const std::string& by) {
  for (std::size_t at = text.find(path); at != std::string::npos;) {
    const bool alone = stands_alone(text, at, path.size());
    if (alone) text.replace(at, path.size(), by);
    at = text.find(path, at + (alone ? by.size() : 1));
  }
}

/// Longest first, as one may be within another.
std::vector<std::size_t> by_length(const std::vector<std::string>& paths) {
  std::vector<std::size_t> order(paths.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return paths[a].size() > paths[b].size(); });
  return order;
}

/// Line breaks and tabs are no harm in JSON.
bool is_text(const std::string& text) {
  std::string plain = text;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return printable(plain) == plain;
}

}  // namespace

std::string portable_text(const std::string& text, const std::vector<std::string>& paths) {
  std::string portable = is_text(text) ? text : printable(text);
  for (const std::size_t k : by_length(paths))
    if (!paths[k].empty()) replace_all(portable, paths[k], fmt::format("{0}{1}{0}", kMark, k));
  return portable;
}

std::string text_here(const std::string& text, const std::vector<std::string>& paths) {
  std::string here;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text[at] == kMark ? text.find(kMark, at + 1) : std::string::npos;
    std::size_t k = 0;
    if (end != std::string::npos) std::from_chars(text.data() + at + 1, text.data() + end, k);
    if (end == std::string::npos || k >= paths.size()) {
      here += text[at++];
      continue;
    }
    here += paths[k];
    at = end + 1;
  }
  return here;
}

}  // namespace cablefit
