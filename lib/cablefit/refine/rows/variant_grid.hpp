// The values of nonlinear parameters, times of events and forms that a scan tries for a row of the
// catalogue. Internal to refine/.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "cablefit/refine/rows/design.hpp"

namespace cablefit {

/// Every combination of the grid's values and of the possible times of an event; none where no log
/// is long enough. `event_step`: s, longest distance between times of a passing event.
std::vector<Variant> variants_of(const Effect& row, const Design& design, double event_step);

/// The plain form at the same shape; nothing where the plain form has another shape.
std::optional<Variant> plain_of(Variant variant);
/// The other form of the same law, starting at the same shape.
Variant other_form(Variant variant);

/// The variant with another value of one shape; a passing event keeps its middle.
Variant with_shape(Variant variant, std::size_t shape, double value);

/// One step of the grid to either side, within the grid.
std::pair<double, double> around(const ShapeGrid& grid, double value, const LogScale& scale);
/// One step between times to either side, within the possible times of an event.
std::pair<double, double> dates_around(const Design& design, const Variant& variant,
                                       double event_step);

}  // namespace cablefit
