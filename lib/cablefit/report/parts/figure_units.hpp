// The same unit on an axis as in the tables. Internal to report/.
#pragma once

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Deflections, initial elongations and gaps of positions are small: tables print them in mrad or
/// mm, so that their axes do.
Figure in_table_units(Figure figure);

}  // namespace cablefit
