// An estimate as two cells of a table: its value, and its rsd or a note that says why it has none.
#pragma once

#include <string>

#include "cablefit/base/parameter.hpp"
#include "cablefit/report/parts/document_parts.hpp"

namespace cablefit {

/// Significant digits of a relative sd.
inline constexpr int kRsdDigits = 2;

struct EstimateCells {
  std::string value, rsd;
};

/// nullptr: the fit has no such parameter.
EstimateCells cells_of(const Estimate* e, Footnotes& notes);

/// J_link without the mass that hangs on it, whose own inertia (kg m^2) is known.
EstimateCells cells_without_load(const Estimate* e, double load_inertia);

}  // namespace cablefit
