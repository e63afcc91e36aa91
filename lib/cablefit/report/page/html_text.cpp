#include "cablefit/report/page/html_text.hpp"

#include <array>

#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_word(char c) { return is_lower(c) || is_digit(c) || (c >= 'A' && c <= 'Z') || c == '_'; }

std::string replaced(std::string_view text, std::string_view what, std::string_view by) {
  std::string result;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what)) {
    result += text.substr(0, at);
    result += by;
    text.remove_prefix(at + what.size());
  }
  return result.append(text);
}

constexpr std::array<std::string_view, 10> kPowers{"⁰", "¹", "²", "³", "⁴",
                                                   "⁵", "⁶", "⁷", "⁸", "⁹"};

/// Whether the word at `at` is the name of a file: it has a dot before a letter.
bool is_in_file_name(std::string_view text, std::size_t at) {
  const std::size_t space = text.rfind(' ', at);
  const std::size_t begin = space == std::string_view::npos ? 0 : space + 1;
  const std::string_view word = text.substr(begin, text.find(' ', at) - begin);
  for (std::size_t i = 0; i + 1 < word.size(); ++i)
    if (word[i] == '.' && is_word(word[i + 1]) && !is_digit(word[i + 1])) return true;
  return false;
}

/// theta and tau in Greek, "tau" not within another word, and neither in the names of files.
std::string with_greek(std::string_view text) {
  constexpr std::string_view kTau = "tau", kTheta = "theta";
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool begins = i == 0 || !is_word(text[i - 1]);
    const std::string_view rest = text.substr(i);
    const bool is_theta = rest.starts_with(kTheta);
    const bool is_tau =
        begins && rest.starts_with(kTau) && (rest.size() == 3 || !is_lower(rest[3]));
    if ((is_theta || is_tau) && !is_in_file_name(text, i)) {
      result += is_theta ? "θ" : "τ";
      i += (is_theta ? kTheta : kTau).size() - 1;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string escaped;
  for (const char c : isolated(printable(text))) switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  return escaped;
}

std::string pretty_unit(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '^' || i + 1 == text.size() || !is_digit(text[i + 1])) {
      result += text[i];
      continue;
    }
    for (; i + 1 < text.size() && is_digit(text[i + 1]); ++i)
      result += kPowers[static_cast<std::size_t>(text[i + 1] - '0')];
  }
  return result;
}

std::string pretty_symbols(std::string_view text) {
  return replaced(with_greek(text), " - ", " − ");
}

std::string pretty_cell(std::string_view text) {
  return pretty_unit(replaced(replaced(text, "+- ", "± "), " -> ", " → "));
}

}  // namespace cablefit
