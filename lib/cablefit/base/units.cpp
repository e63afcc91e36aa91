#include "cablefit/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/base/trim.hpp"
#include "cablefit/base/unit_symbols.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMaxUnitBytes = 64;
constexpr int kMaxExponent = 9;

constexpr std::array<std::string_view, 3> kDots{".", "*", "\u00b7"};

struct Superscript {
  std::string_view name;
  std::string_view plain;
};
constexpr std::array kSuperscripts{
    Superscript{"\u207b", "-"}, Superscript{"\u00b9", "1"}, Superscript{"\u00b2", "2"},
    Superscript{"\u00b3", "3"}, Superscript{"\u2074", "4"},
};

class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : whole_(text), rest_(text) {}

  Unit parse() {
    const Unit unit = parse_product();
    if (!rest_.empty()) throw malformed(fmt::format("has {} out of place", in_quotes(rest_)));
    return unit;
  }

 private:
  Unit parse_product() {
    Unit unit = parse_factor();
    while (true) {
      skip_blanks();
      if (rest_.empty() || rest_.front() == ')') return unit;
      const bool is_quotient = skip("/");
      if (!is_quotient) skip_dot();
      unit = product(unit, power(parse_factor(), is_quotient ? -1 : 1));
    }
  }

  Unit parse_factor() {
    skip_blanks();
    if (skip("(")) {
      const Unit unit = parse_product();
      if (!skip(")")) throw malformed("lacks a ')'");
      return power(unit, parse_exponent());
    }
    if (skip("1")) return {};
    const std::string_view word = take_word();
    if (word.empty()) {
      throw malformed("lacks a unit at " + (rest_.empty() ? "its end" : in_quotes(rest_)));
    }
    const int exponent = parse_exponent();
    const auto unit = word_to_unit(word, exponent);
    if (!unit) throw input_error({}, unknown(word), known_units_near(word));
    return *unit;
  }

  // "^2", "^-1", "2" and "-1" behind a unit, and superscripts.
  int parse_exponent() {
    const bool is_marked = skip("^");
    std::string digits = take_superscripts();
    if (digits.empty()) digits = take_integer();
    if (digits == "-") throw malformed("has a sign without an exponent");
    if (digits.empty() && is_marked) throw malformed("has no integer after '^'");
    if (digits.empty()) return 1;
    const int exponent = digits.size() > 3 ? kMaxExponent + 1 : std::atoi(digits.c_str());
    if (std::abs(exponent) > kMaxExponent) throw malformed("has an exponent beyond 9");
    return exponent;
  }

  std::string take_superscripts() {
    std::string plain;
    for (auto it = kSuperscripts.begin(); it != kSuperscripts.end();) {
      if (!skip(it->name)) {
        ++it;
        continue;
      }
      plain += it->plain;
      it = kSuperscripts.begin();
    }
    return plain;
  }

  std::string take_integer() {
    const std::size_t n_sign = !rest_.empty() && (rest_[0] == '-' || rest_[0] == '+') ? 1 : 0;
    const std::size_t end = std::min(rest_.find_first_not_of("0123456789", n_sign), rest_.size());
    if (end == n_sign) return {};
    std::string digits(rest_.substr(0, end));
    rest_.remove_prefix(end);
    return digits;
  }

  std::string_view take_word() {
    std::size_t end = 0;
    while (end < rest_.size() && is_letter_at(end)) ++end;
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return word;
  }

  // Bytes beyond ASCII are letters (micro, degree) except for the dots and superscripts above.
  bool is_letter_at(std::size_t at) const {
    const std::string_view tail = rest_.substr(at);
    const auto starts_tail = [&](const auto& name) { return tail.starts_with(name); };
    if (std::any_of(kDots.begin(), kDots.end(), starts_tail)) return false;
    if (std::any_of(kSuperscripts.begin(), kSuperscripts.end(),
                    [&](const Superscript& s) { return starts_tail(s.name); })) {
      return false;
    }
    const auto c = static_cast<unsigned char>(tail[0]);
    return std::isalpha(c) != 0 || c == '%' || c >= 0x80;
  }

  void skip_blanks() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size()));
  }
  bool skip(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }
  // A minus before a letter joins too: "N-m". Before a digit it is a misplaced exponent.
  void skip_dot() {
    const bool is_minus = rest_.size() > 1 && rest_[0] == '-';
    if (is_minus && std::isalpha(static_cast<unsigned char>(rest_[1])) != 0) skip("-");
    std::any_of(kDots.begin(), kDots.end(), [&](std::string_view dot) { return skip(dot); });
  }

  std::string unknown(std::string_view word) const {
    const std::string what = "unknown unit " + in_quotes(word);
    return word == whole_ ? what : what + " in " + in_quotes(whole_);
  }
  Error malformed(const std::string& what) const {
    return input_error({}, "unit " + in_quotes(whole_) + ' ' + what,
                       "write it as N m, rad/s or m/s^2");
  }

  std::string_view whole_;
  std::string_view rest_;
};

}  // namespace

Unit parse_unit(std::string_view text) {
  const std::string_view unit = trimmed(text);
  if (unit.empty() || unit == "-") return {};
  if (unit.size() > kMaxUnitBytes) {
    throw input_error({}, "unit " + in_quotes(unit) + " is too long", "write it as N m or rad/s");
  }
  return UnitParser(unit).parse();
}

}  // namespace cablefit
