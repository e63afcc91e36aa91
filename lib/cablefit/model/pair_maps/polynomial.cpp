#include "cablefit/model/pair_maps/kinds.hpp"

namespace cablefit::pair_maps {
namespace {

PairParameters read(const JsonNode& node, MapSide /*side*/) {
  node.allow_only({"type", "joints", "coefficients"});
  const JsonNode& list = node.at("coefficients");
  PairParameters p;
  p.values = read_matrix(list);
  Eigen::MatrixXd moving = p.values;
  if (moving.size() > 0) moving(0, 0) = 0;
  if (moving.isZero(0)) {
    throw list.error("no radius", "give c_ij of the sum of c_ij x1^i x2^j, one list per i, in m");
  }
  return p;
}

std::vector<PairEntry> entries(const PairParameters& p) {
  return {{"coefficients", lists_of(p.values)}};
}

/// A polynomial and its first two derivatives, by Horner.
struct Value {
  double value = 0, slope = 0, curvature = 0;
};

template <typename Coefficient>
Value horner(Eigen::Index n, double x, Coefficient coefficient) {
  Value v;
  for (Eigen::Index k = n; k-- > 0;) {
    v.curvature = v.curvature * x + 2 * v.slope;
    v.slope = v.slope * x + v.value;
    v.value = v.value * x + coefficient(k);
  }
  return v;
}

PairValue at(const PairParameters& p, double x1, double x2) {
  // Of each power of x1 the polynomial in x2; then of these three the polynomials in x1.
  const auto row = [&](Eigen::Index i) {
    return horner(p.values.cols(), x2, [&](Eigen::Index j) { return p.values(i, j); });
  };
  const Eigen::Index n = p.values.rows();
  const Value f = horner(n, x1, [&](Eigen::Index i) { return row(i).value; });
  const Value f2 = horner(n, x1, [&](Eigen::Index i) { return row(i).slope; });
  const Value f22 = horner(n, x1, [&](Eigen::Index i) { return row(i).curvature; });
  PairValue all;
  all.displacement = f.value;
  all.radius << f.slope, f2.value;
  all.slope << f.curvature, f2.slope, f2.slope, f22.value;
  return all;
}

}  // namespace

PairMapKind polynomial() {
  return {.name = "polynomial",
          .equation = "sum_ij c_ij x1^i x2^j",
          .source = "Fichera & Grossard 2017, (3)-(4): any smooth map",
          .rotary_only = false,
          .read = read,
          .entries = entries,
          .at = at};
}

}  // namespace cablefit::pair_maps
