// The table of unit symbols and SI prefixes, and how single words ("mN", "Nm", "kgm") are read.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cablefit/base/units.hpp"

namespace cablefit {

Unit product(const Unit& a, const Unit& b);
Unit power(const Unit& unit, int exponent);

/// A word between separators, or nothing when it is unknown. The exponent written behind it belongs
/// to its last unit: "kgm2" is kg m^2.
std::optional<Unit> word_to_unit(std::string_view word, int exponent);

/// A hint for an unknown word.
std::string known_units_near(std::string_view word);

}  // namespace cablefit
