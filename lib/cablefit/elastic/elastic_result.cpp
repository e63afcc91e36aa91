#include "cablefit/elastic/elastic_result.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cablefit {

MisfitPoint ElasticMisfit::at(double deflection) const {
  if (points.empty()) return {deflection, 0, 0};
  const auto above =
      std::lower_bound(points.begin(), points.end(), deflection,
                       [](const MisfitPoint& point, double phi) { return point.deflection < phi; });
  if (above == points.begin()) return points.front();
  if (above == points.end()) return points.back();
  const MisfitPoint& below = *(above - 1);
  const double share = (deflection - below.deflection) / (above->deflection - below.deflection);
  return {deflection, below.torque + share * (above->torque - below.torque),
          below.half_width + share * (above->half_width - below.half_width)};
}

const ElasticFit* ElasticPreload::find(const std::string& model) const {
  for (const ElasticFit& fit : fits)
    if (fit.model == model) return &fit;
  return nullptr;
}

std::string order_text(const ElasticFit& fit) {
  std::string each;
  bool alike = true;
  for (const Cable& cable : fit.transmission.cables) {
    each += fmt::format("{}{}", each.empty() ? "" : ", ", cable.order);
    alike = alike && cable.order == fit.order;
  }
  return alike ? fmt::format("order {}", fit.order) : "orders " + each;
}

std::string model_text(const ElasticFit& fit) {
  return fit.model == "linear" ? fit.model : fmt::format("{}, {}", fit.model, order_text(fit));
}

ElasticResult::ElasticResult() = default;
ElasticResult::ElasticResult(const ElasticResult&) = default;
ElasticResult::ElasticResult(ElasticResult&&) noexcept = default;
ElasticResult& ElasticResult::operator=(const ElasticResult&) = default;
ElasticResult& ElasticResult::operator=(ElasticResult&&) noexcept = default;
ElasticResult::~ElasticResult() = default;

}  // namespace cablefit
