// Division of whole numbers that rounds up: rows to pieces, edges to fewer rows.
#pragma once

#include <cstddef>

namespace cablefit {

/// Smallest whole number not below a/b; a >= 0, b > 0.
constexpr std::ptrdiff_t divided_up(std::ptrdiff_t a, std::ptrdiff_t b) { return (a + b - 1) / b; }

}  // namespace cablefit
