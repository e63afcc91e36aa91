#include "cablefit/log/iso_time.hpp"

#include <charconv>
#include <chrono>
#include <cmath>

namespace cablefit {
namespace {

/// Takes what it understands off the front of a text.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  bool at_end() const { return text_.empty(); }
  bool take(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take_any(char a, char b) { return take(a) || take(b); }
  /// Exactly `n_digits` digits.
  bool take(std::size_t n_digits, int& value) {
    if (text_.size() < n_digits) return false;
    const char* const end = text_.data() + n_digits;
    if (text_.front() < '0' || text_.front() > '9') return false;
    if (std::from_chars(text_.data(), end, value).ptr != end) return false;
    text_.remove_prefix(n_digits);
    return true;
  }
  /// The digits behind a decimal point, as a number below 1.
  bool take_fraction(double& value) {
    std::size_t n = 0;
    double digits = 0;
    for (; n < text_.size() && text_[n] >= '0' && text_[n] <= '9'; ++n)
      digits = 10 * digits + (text_[n] - '0');
    value = digits / std::pow(10.0, static_cast<double>(n));
    text_.remove_prefix(n);
    return n > 0 && n <= 15;
  }

 private:
  std::string_view text_;
};

std::optional<long> day_of(int year, int month, int day) {
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count();
}

/// Seconds that a zone is ahead of UTC; empty when something else stands there.
std::optional<int> read_zone(Scanner& rest) {
  if (rest.at_end() || rest.take('Z')) return 0;
  const int sign = rest.take('+') ? 1 : rest.take('-') ? -1 : 0;
  int hours = 0, minutes = 0;
  if (sign == 0 || !rest.take(2, hours)) return std::nullopt;
  rest.take(':');
  if (!rest.at_end() && !rest.take(2, minutes)) return std::nullopt;
  return sign * (3600 * hours + 60 * minutes);
}

}  // namespace

std::optional<IsoTime> read_iso_time(std::string_view text) {
  Scanner rest(text);
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  double fraction = 0;
  if (!rest.take(4, year) || !rest.take('-') || !rest.take(2, month) || !rest.take('-') ||
      !rest.take(2, day) || !rest.take_any('T', ' ') || !rest.take(2, hour) || !rest.take(':') ||
      !rest.take(2, minute))
    return std::nullopt;
  if (rest.take(':') && !rest.take(2, second)) return std::nullopt;
  if (rest.take_any('.', ',') && !rest.take_fraction(fraction)) return std::nullopt;
  const std::optional<int> zone = read_zone(rest);
  const std::optional<long> days = day_of(year, month, day);
  if (!zone || !rest.at_end() || !days || hour > 24 || minute > 59 || second > 60)
    return std::nullopt;
  return IsoTime{*days, 3600.0 * hour + 60.0 * minute + second - *zone + fraction};
}

}  // namespace cablefit
