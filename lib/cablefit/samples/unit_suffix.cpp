#include "cablefit/samples/unit_suffix.hpp"

#include <array>

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

}  // namespace

std::optional<SuffixedName> split_unit_suffix(std::string_view column, const Dimension& wanted) {
  for (const Suffix& suffix : kSuffixes) {
    const bool fits = column.size() > suffix.ending.size() && column.ends_with(suffix.ending) &&
                      parse_unit(suffix.unit).dimension == wanted;
    if (fits)
      return SuffixedName{column.substr(0, column.size() - suffix.ending.size()), suffix.unit};
  }
  return std::nullopt;
}

bool is_current_name(std::string_view column) {
  return column.size() > 2 && (column.ends_with("_A") || column.ends_with("_mA"));
}

}  // namespace cablefit
