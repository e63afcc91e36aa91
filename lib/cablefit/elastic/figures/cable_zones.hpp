// Between which deflections which cables are slack, for figures of one joint: force closure (12)
// and disclosure (13), Fichera & Grossard 2017, Fig. 3d.
#pragma once

#include <string>
#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Deflections between two changes of a cable.
struct CableZone {
  double low, high;
  std::string slack;  ///< names, "1, 2"; empty: force closure
};
std::vector<CableZone> zones_of(const Transmission& transmission, double low, double high);

/// Where a cable goes slack, by the names of the cables.
std::vector<Mark> slack_marks(const Transmission& transmission, double low, double high);

/// Whether a zone of an axis from `low` to `high` is wide enough for a word.
inline bool has_room(const CableZone& zone, double low, double high) {
  return zone.high - zone.low > 0.1 * (high - low);
}

/// "all taut", "slack: 1".
std::string zone_text(const CableZone& zone);

/// Rectangles, one after the other, for a trace of areas.
void add_box(const CableZone& zone, double from, double to, Trace& area);

}  // namespace cablefit
