#include "cablefit/campaign/plan/folder_date.hpp"

#include <fmt/format.h>

#include <chrono>
#include <regex>

namespace cablefit {
namespace {

namespace chr = std::chrono;

constexpr std::size_t kDateBytes = 12;  // std::regex calls itself for every character

std::optional<std::string> iso_date(int year, int month, int day) {
  const chr::year_month_day date{chr::year(year), chr::month(static_cast<unsigned>(month)),
                                 chr::day(static_cast<unsigned>(day))};
  if (!date.ok() || year < 1980 || year > 2200) return std::nullopt;
  return fmt::format("{:04}-{:02}-{:02}", year, month, day);
}

/// Week 1 is the one that holds 4 January.
std::optional<std::string> monday_of(int year, int week) {
  if (week < 1 || week > 53) return std::nullopt;
  const chr::sys_days fourth{chr::year(year) / 1 / 4};
  const chr::sys_days first = fourth - (chr::weekday(fourth) - chr::Monday);
  const chr::year_month_day monday{first + chr::weeks(week - 1)};
  return iso_date(static_cast<int>(monday.year()),
                  static_cast<int>(static_cast<unsigned>(monday.month())),
                  static_cast<int>(static_cast<unsigned>(monday.day())));
}

}  // namespace

std::optional<std::string> date_of_folder(const std::string& name) {
  static const std::regex year_first("(\\d{4})[-_.]?(\\d\\d)[-_.]?(\\d\\d)");
  static const std::regex day_first("(\\d\\d)[-_.](\\d\\d)[-_.](\\d{4})");
  static const std::regex week("(\\d{4})[-_]?[wW](\\d\\d?)");
  std::smatch found;
  if (name.size() > kDateBytes) return std::nullopt;
  const auto number = [&found](int k) { return std::stoi(found[static_cast<std::size_t>(k)]); };
  if (std::regex_match(name, found, year_first)) return iso_date(number(1), number(2), number(3));
  if (std::regex_match(name, found, day_first)) return iso_date(number(3), number(2), number(1));
  if (std::regex_match(name, found, week)) return monday_of(number(1), number(2));
  return std::nullopt;
}

}  // namespace cablefit
