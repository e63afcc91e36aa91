#include "cablefit/model/pair_maps/pair_maps.hpp"

#include "cablefit/base/catalog.hpp"
#include "cablefit/model/pair_maps/kinds.hpp"

namespace cablefit {
namespace {

const std::vector<PairMapKind>& table() {
  static const std::vector<PairMapKind> kRows{pair_maps::grid(), pair_maps::polynomial(),
                                              pair_maps::guides()};
  return kRows;
}

}  // namespace

std::span<const PairMapKind> pair_map_kinds() { return table(); }

const PairMapKind& find_pair_map_kind(std::string_view name) {
  return find_row(pair_map_kinds(), "map of two joints", name);
}

PairMap scaled(PairMap map, double factor) {
  // Every kind is linear in its displacements or coefficients, or in the size of its geometry.
  PairParameters& p = map.parameters;
  p.values *= factor;
  for (Eigen::MatrixXd& curvature : p.curvature) curvature *= factor;
  p.from *= factor;
  p.to *= factor;
  p.length *= factor;
  return map;
}

}  // namespace cablefit
