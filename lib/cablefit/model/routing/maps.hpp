// The rows of the table of displacement maps, one per file. Internal to routing.cpp; everybody else
// goes through map_kinds().
#pragma once

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/routing.hpp"

namespace cablefit::maps {

/// A round pulley: r x.
MapKind radius();
/// A radius that is a polynomial of the angle.
MapKind polynomial();
/// Measured points with a spline between them.
MapKind table();

}  // namespace cablefit::maps
