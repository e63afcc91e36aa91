#include "cablefit/base/unit_symbols.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "cablefit/base/catalog.hpp"

namespace cablefit {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Symbol {
  std::string_view name;
  Unit unit;
  bool takes_prefix;
  bool joins;  // another unit may follow without a separator: "Nm", "kgm2", "Vs"
};

constexpr Dimension kNumber{0, 0, 0, 0};
constexpr Dimension kTime{0, 0, 1, 0};
constexpr Dimension kFrequency{0, 0, -1, 0};

constexpr std::array kSymbols{
    Symbol{"m", {1.0, {1, 0, 0, 0}}, true, false},
    Symbol{"g", {1e-3, {0, 1, 0, 0}}, true, true},
    Symbol{"s", {1.0, kTime}, true, false},
    Symbol{"min", {60.0, kTime}, false, false},
    Symbol{"h", {3600.0, kTime}, false, false},
    Symbol{"Hz", {1.0, kFrequency}, true, false},
    Symbol{"A", {1.0, {0, 0, 0, 1}}, true, true},
    Symbol{"V", {1.0, {2, 1, -3, -1}}, true, true},
    Symbol{"W", {1.0, {2, 1, -3, 0}}, true, true},
    Symbol{"J", {1.0, {2, 1, -2, 0}}, true, true},
    Symbol{"N", {1.0, {1, 1, -2, 0}}, true, true},
    Symbol{"rad", {1.0, kNumber}, true, false},
    Symbol{"deg", {kTurn / 360.0, kNumber}, true, false},
    Symbol{"\u00b0", {kTurn / 360.0, kNumber}, false, false},
    Symbol{"grad", {kTurn / 400.0, kNumber}, false, false},
    Symbol{"rev", {kTurn, kNumber}, false, false},
    Symbol{"turn", {kTurn, kNumber}, false, false},
    Symbol{"rpm", {kTurn / 60.0, kFrequency}, true, false},
    Symbol{"%", {0.01, kNumber}, false, false},
};

struct Prefix {
  std::string_view name;
  double factor;
};

// No deca: "da" is not used for anything measured here. Two code points are in use for micro.
constexpr std::array kPrefixes{
    Prefix{"f", 1e-15},     Prefix{"p", 1e-12},     Prefix{"n", 1e-9}, Prefix{"u", 1e-6},
    Prefix{"\u00b5", 1e-6}, Prefix{"\u03bc", 1e-6}, Prefix{"m", 1e-3}, Prefix{"c", 1e-2},
    Prefix{"d", 1e-1},      Prefix{"h", 1e2},       Prefix{"k", 1e3},  Prefix{"M", 1e6},
    Prefix{"G", 1e9},
};

const Symbol* find_symbol(std::string_view name) {
  const auto found = std::find_if(kSymbols.begin(), kSymbols.end(),
                                  [&](const Symbol& symbol) { return symbol.name == name; });
  return found == kSymbols.end() ? nullptr : &*found;
}

// A symbol as it stands or with a prefix. As it stands goes first: "min" is no milli-inch.
std::optional<Symbol> prefixed_symbol(std::string_view word) {
  if (const Symbol* symbol = find_symbol(word)) return *symbol;
  for (const Prefix& prefix : kPrefixes) {
    if (!word.starts_with(prefix.name)) continue;
    const Symbol* symbol = find_symbol(word.substr(prefix.name.size()));
    if (symbol == nullptr || !symbol->takes_prefix) continue;
    Symbol scaled = *symbol;
    scaled.unit.scale *= prefix.factor;
    return scaled;
  }
  return std::nullopt;
}

// What follows a joining symbol: "m" of "Nm", "mm" of "Nmm", "ms" of "Nms". Only lengths keep
// their prefix there, since "Nms" is newton metre second.
std::optional<Unit> joined_tail(std::string_view word, int exponent) {
  if (word == "mm" || word == "cm") return power(prefixed_symbol(word)->unit, exponent);
  if (const Symbol* symbol = find_symbol(word)) return power(symbol->unit, exponent);
  const Symbol* head = find_symbol(word.substr(0, 1));
  if (word.size() < 2 || head == nullptr) return std::nullopt;
  const auto tail = joined_tail(word.substr(1), exponent);
  if (!tail) return std::nullopt;
  return product(head->unit, *tail);
}

}  // namespace

Unit product(const Unit& a, const Unit& b) {
  Unit result{a.scale * b.scale, a.dimension};
  for (std::size_t i = 0; i < b.dimension.size(); ++i) result.dimension[i] += b.dimension[i];
  return result;
}

Unit power(const Unit& unit, int exponent) {
  Unit result{std::pow(unit.scale, exponent), unit.dimension};
  for (int& exponent_of_base : result.dimension) exponent_of_base *= exponent;
  return result;
}

std::optional<Unit> word_to_unit(std::string_view word, int exponent) {
  if (const auto symbol = prefixed_symbol(word)) return power(symbol->unit, exponent);
  for (std::size_t n_head = word.size(); n_head-- > 1;) {
    const auto head = prefixed_symbol(word.substr(0, n_head));
    if (!head || !head->joins) continue;
    if (const auto tail = joined_tail(word.substr(n_head), exponent)) {
      return product(head->unit, *tail);
    }
  }
  return std::nullopt;
}

std::string known_units_near(std::string_view word) {
  std::array<std::string_view, kSymbols.size()> names;
  std::transform(kSymbols.begin(), kSymbols.end(), names.begin(),
                 [](const Symbol& symbol) { return symbol.name; });
  return suggestion(word, names);
}

}  // namespace cablefit
