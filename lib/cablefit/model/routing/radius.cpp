#include "cablefit/model/routing/maps.hpp"

namespace cablefit::maps {
namespace {

MapParameters read(const JsonNode& node) {
  node.allow_only({"type", "radius"});
  return {{node.at("radius").number()}, {}, {}, {}};
}

std::vector<MapEntry> entries(const MapParameters& p) {
  return {{"radius", p.coefficients.front()}};
}

double displacement(const MapParameters& p, double angle) { return p.coefficients.front() * angle; }

double radius_at(const MapParameters& p, double /*angle*/) { return p.coefficients.front(); }

double radius_slope(const MapParameters& /*p*/, double /*angle*/) { return 0.0; }

}  // namespace

MapKind radius() {
  return {.name = "radius",
          .equation = "r x (a bare number: the radius of a round pulley)",
          .source = "Fichera & Grossard 2017, (3), (15)",
          .constant_radius = true,
          .read = read,
          .entries = entries,
          .displacement = displacement,
          .radius = radius_at,
          .radius_slope = radius_slope};
}

}  // namespace cablefit::maps
