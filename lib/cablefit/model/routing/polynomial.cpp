#include <algorithm>

#include "cablefit/model/routing/maps.hpp"

namespace cablefit::maps {
namespace {

MapParameters read(const JsonNode& node) {
  node.allow_only({"type", "coefficients"});
  const JsonNode& list = node.at("coefficients");
  MapParameters parameters{list.numbers(), {}, {}, {}};
  const std::vector<double>& r = parameters.coefficients;
  if (std::all_of(r.begin(), r.end(), [](double value) { return value == 0; })) {
    throw list.error("no radius", "give r_0, r_1, ... of the radius r_0 + r_1 x + ... in m");
  }
  return parameters;
}

std::vector<MapEntry> entries(const MapParameters& p) { return {{"coefficients", p.coefficients}}; }

/// sum_j weight(j) r_j x^(j - low) over j >= low, by Horner.
template <typename Weight>
double horner(const MapParameters& p, std::size_t low, double x, Weight weight) {
  double sum = 0;
  for (std::size_t j = p.coefficients.size(); j-- > low;) {
    sum = sum * x + weight(static_cast<double>(j)) * p.coefficients[j];
  }
  return sum;
}

double displacement(const MapParameters& p, double x) {
  return x * horner(p, 0, x, [](double j) { return 1 / (j + 1); });
}

double radius_at(const MapParameters& p, double x) {
  return horner(p, 0, x, [](double) { return 1.0; });
}

double radius_slope(const MapParameters& p, double x) {
  return horner(p, 1, x, [](double j) { return j; });
}

}  // namespace

MapKind polynomial() {
  return {.name = "polynomial",
          .equation = "r_0 x + r_1 x^2/2 + ... (radius r_0 + r_1 x + ...)",
          .source = "Fichera & Grossard 2017, (3)-(4): any smooth map",
          .constant_radius = false,
          .read = read,
          .entries = entries,
          .displacement = displacement,
          .radius = radius_at,
          .radius_slope = radius_slope};
}

}  // namespace cablefit::maps
