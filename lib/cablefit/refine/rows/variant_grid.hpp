// Which values of its nonlinear parameters, which dates and which forms of a row of the catalogue a
// scan tries. Internal to refine/.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Every combination of the grid's values, and of the dates at which an event may have happened;
/// none where no log is long enough for one. `event_step`: s, longest between dates of what passes.
std::vector<Variant> variants_of(const Effect& row, const Design& design, double event_step);

/// The plain form at the same shape; nothing where the shape is another one.
std::optional<Variant> plain_of(Variant variant);
/// The other form of the same law, to begin with at the same shape.
Variant other_form(Variant variant);

/// The variant with another value of one shape; what passes keeps its middle.
Variant with_shape(Variant variant, std::size_t shape, double value);

/// A step of the grid to either side, as far as the grid goes.
std::pair<double, double> around(const ShapeGrid& grid, double value, const LogScale& scale);
/// A step between dates to either side, as far as an event may have happened.
std::pair<double, double> dates_around(const Design& design, const Variant& variant,
                                       double event_step);

}  // namespace cablefit
