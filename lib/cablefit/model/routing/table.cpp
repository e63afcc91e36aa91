#include <algorithm>
#include <cmath>
#include <functional>

#include "cablefit/model/routing/maps.hpp"
#include "cablefit/model/routing/spline.hpp"

namespace cablefit::maps {
namespace {

MapParameters read(const JsonNode& node) {
  node.allow_only({"type", "angle", "displacement"});
  const JsonNode& angle = node.at("angle");
  MapParameters p{{}, angle.numbers(), node.at("displacement").numbers(), {}};
  if (p.angle.size() < 2) {
    throw angle.error("a table needs at least two points", "give angle and displacement as lists");
  }
  if (p.angle.size() != p.displacement.size()) {
    throw node.at("displacement")
        .error("angle and displacement have different lengths", "one displacement per angle");
  }
  const auto step_back = std::adjacent_find(p.angle.begin(), p.angle.end(),
                                            [](double a, double b) { return !(a < b); });
  if (step_back != p.angle.end()) {
    const auto at = static_cast<std::size_t>(step_back - p.angle.begin()) + 1;
    throw angle.items[at].error("angle must ascend", "sort the points by angle");
  }
  if (std::adjacent_find(p.displacement.begin(), p.displacement.end(), std::not_equal_to<>()) ==
      p.displacement.end()) {
    throw node.at("displacement").error("all displacements are the same", "use the radius 0");
  }
  p.curvature = spline_curvature(p.angle, p.displacement);
  if (!std::all_of(p.curvature.begin(), p.curvature.end(),
                   [](double c) { return std::isfinite(c); })) {
    throw angle.error("angles are too close together", "no finite curve goes through these points");
  }
  return p;
}

std::vector<MapEntry> entries(const MapParameters& p) {
  return {{"angle", p.angle}, {"displacement", p.displacement}};
}

SplineValue at(const MapParameters& p, double angle) {
  return spline_at(p.angle, p.displacement, p.curvature, angle);
}

double displacement(const MapParameters& p, double angle) { return at(p, angle).value; }

double radius_at(const MapParameters& p, double angle) { return at(p, angle).slope; }

double radius_slope(const MapParameters& p, double angle) { return at(p, angle).curvature; }

}  // namespace

MapKind table() {
  return {.name = "table",
          .equation = "cubic spline through (angle, displacement), straight outside",
          .source = "de Boor 1978, ch. IV: not-a-knot ends",
          .constant_radius = false,
          .read = read,
          .entries = entries,
          .displacement = displacement,
          .radius = radius_at,
          .radius_slope = radius_slope};
}

}  // namespace cablefit::maps
