#include "cablefit/samples/plan/unit_suffix.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace cablefit {
namespace {

struct Suffix {
  std::string_view ending, unit;
};
// Longer ones first where one ends in another.
constexpr std::array<Suffix, 24> kSuffixes = {{
    {"_deg_s", "deg/s"}, {"_deg_per_s", "deg/s"}, {"_dps", "deg/s"},
    {"_rad_s", "rad/s"}, {"_rad_per_s", "rad/s"}, {"_rpm", "rpm"},
    {"_mm_s", "mm/s"},   {"_m_s", "m/s"},         {"_deg", "deg"},
    {"_mrad", "mrad"},   {"_rad", "rad"},         {"_mNm", "mN m"},
    {"_Ncm", "N cm"},    {"_kNm", "kN m"},        {"_Nm", "N m"},
    {"_kN", "kN"},       {"_mN", "mN"},           {"_N", "N"},
    {"_ms", "ms"},       {"_us", "us"},           {"_ns", "ns"},
    {"_s", "s"},         {"_mm", "mm"},           {"_m", "m"},
}};

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

bool ends_in(std::string_view name, std::string_view ending) {
  if (name.size() <= ending.size()) return false;
  const std::string_view end = name.substr(name.size() - ending.size());
  if (ending.size() == 2) return end == ending;
  return std::equal(end.begin(), end.end(), ending.begin(), same_letter);
}

}  // namespace

std::optional<SuffixedName> split_unit_suffix(std::string_view column, const Dimension& wanted) {
  for (const Suffix& suffix : kSuffixes) {
    if (ends_in(column, suffix.ending) && parse_unit(suffix.unit).dimension == wanted)
      return SuffixedName{column.substr(0, column.size() - suffix.ending.size()), suffix.unit};
  }
  return std::nullopt;
}

bool is_milliampere_name(std::string_view column) { return ends_in(column, "_mA"); }

bool is_current_name(std::string_view column) {
  return ends_in(column, "_A") || is_milliampere_name(column);
}

std::string_view stem_of_current(std::string_view column) {
  return is_current_name(column) ? column.substr(0, column.rfind('_')) : std::string_view();
}

}  // namespace cablefit
