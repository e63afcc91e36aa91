#include "cablefit/model/routing.hpp"

#include "cablefit/base/catalog.hpp"
#include "cablefit/model/routing/maps.hpp"

namespace cablefit {
namespace {

const std::vector<MapKind>& map_kind_rows() {
  static const std::vector<MapKind> kRows{maps::radius(), maps::polynomial(), maps::table()};
  return kRows;
}

}  // namespace

std::span<const MapKind> map_kinds() { return map_kind_rows(); }

const MapKind& find_map_kind(std::string_view name) {
  return find_row(map_kinds(), "displacement map", name);
}

Eigen::ArrayXd DisplacementMap::displacements(const Eigen::Ref<const Eigen::ArrayXd>& angle) const {
  if (kind->constant_radius) return radius(0) * angle;
  return angle.unaryExpr([this](double x) { return displacement(x); });
}

Eigen::ArrayXd DisplacementMap::radii(const Eigen::Ref<const Eigen::ArrayXd>& angle) const {
  if (kind->constant_radius) return Eigen::ArrayXd::Constant(angle.size(), radius(0));
  return angle.unaryExpr([this](double x) { return radius(x); });
}

DisplacementMap round_pulley(double radius) {
  return {&map_kinds().front(), {{radius}, {}, {}, {}}};
}

std::vector<DisplacementMap> round_pulleys(const Eigen::VectorXd& radius) {
  std::vector<DisplacementMap> pulleys;
  for (const double r : radius) pulleys.push_back(round_pulley(r));
  return pulleys;
}

}  // namespace cablefit
