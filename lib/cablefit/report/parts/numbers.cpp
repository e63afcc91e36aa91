#include "cablefit/report/parts/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/axes.hpp"

namespace cablefit {
namespace {

constexpr int kDigitsOfSd = 2;
constexpr int kDigitsWithoutSd = 4;
constexpr double kSmallest = 1e-5;  // beyond these an exponent is easier to read
constexpr double kLargest = 1e7;

/// Decimal exponent of the value once it is rounded to so many digits: 0.0996 to two is 0.10.
int exponent_of(double value, int n_digits) {
  const std::string text = fmt::format("{:.{}e}", std::abs(value), n_digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

bool needs_exponent(double value) {
  const double size = std::abs(value);
  return size != 0 && (size < kSmallest || size >= kLargest);
}

bool has_sd(double sd) { return std::isfinite(sd) && sd > 0; }

/// How value and sd are printed alike.
struct Style {
  bool exponent = false;
  int decimals = 0;  ///< negative: rounded to tens, hundreds, ...
};

std::string fixed(double value, int decimals) {
  if (decimals >= 0) return fmt::format("{:.{}f}", value, decimals);
  const double step = std::pow(10.0, -decimals);
  return fmt::format("{:.0f}", step * std::round(value / step));
}

Style style_of(double value, double sd) {
  const int last_digit = exponent_of(sd, kDigitsOfSd) - (kDigitsOfSd - 1);
  const double size = std::max(std::abs(value), sd);
  if (needs_exponent(size)) {
    return {true, std::max(kDigitsOfSd - 1, exponent_of(size, kDigitsOfSd) - last_digit)};
  }
  return {false, -last_digit};
}

}  // namespace

std::string significant(double value, int n_digits) {
  if (!std::isfinite(value)) return kNoNumber;
  if (value == 0) return "0";
  if (needs_exponent(value)) return fmt::format("{:.{}e}", value, n_digits - 1);
  return fixed(value, n_digits - 1 - exponent_of(value, n_digits));
}

std::string value_text(double value, double sd) {
  if (!std::isfinite(value)) return kNoNumber;
  if (!has_sd(sd)) return significant(value, kDigitsWithoutSd);
  const Style style = style_of(value, sd);
  return style.exponent ? fmt::format("{:.{}e}", value, style.decimals)
                        : fixed(value, style.decimals);
}

std::string sd_text(double value, double sd) {
  if (!has_sd(sd)) return sd == 0 ? "0" : kNoNumber;
  const Style style = style_of(value, sd);
  return style.exponent ? fmt::format("{:.{}e}", sd, kDigitsOfSd - 1) : fixed(sd, style.decimals);
}

std::string value_with_sd(double value, double sd) {
  if (!has_sd(sd) || !std::isfinite(value)) return value_text(value, sd);
  return value_text(value, sd) + " +- " + sd_text(value, sd);
}

std::string milli_range(double low, double high) {
  if (!std::isfinite(low)) return kNoNumber;
  return fmt::format("{} .. {}", short_number(kMilli * low), short_number(kMilli * high));
}

std::string exact(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace cablefit
