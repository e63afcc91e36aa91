// Units as people write them in column headers: "deg", "mN m", "N*m", "Nm", "rad/s", "rpm", "kN",
// "mm", "1/s". Products by space, '*' or '.', quotients by '/', integer powers by '^', SI prefixes.
#pragma once

#include <array>
#include <string_view>

namespace cablefit {

/// Exponents of m, kg, s, A. The radian counts as 1: a torque is N m, angle needs no exponent.
using Dimension = std::array<int, 4>;

/// value in SI = scale * value as written.
struct Unit {
  double scale = 1.0;
  Dimension dimension{};
};

/// Throws Error(input) without a place, naming the unknown part and a near match; the caller adds
/// the place. An empty text is the number 1.
Unit parse_unit(std::string_view text);

}  // namespace cablefit
