#include "cablefit/model/cables/bernstein.hpp"
#include "cablefit/model/cables/laws.hpp"

namespace cablefit::laws {
namespace {

int n_coefficients(int order) { return order; }

void basis(int order, double l, double* values) {
  double power = l;
  for (int j = 0; j < order; ++j, power *= l) values[j] = power;
}

void slope(int order, double l, double* values) {
  double power = 1.0;
  for (int j = 0; j < order; ++j, power *= l) values[j] = (j + 1) * power;
}

// Bernstein coefficients of k(l) on pieces of the range. Up to order 2 k is a line and its values
// at both ends say it all; beyond, the coefficients are sufficient and come down to the curve with
// the square of the length of a piece (Farin 2002, 5.3).
constexpr int kPieces = 8;

PullConditions pull_conditions(int order, double longest) {
  const int degree = order - 1;
  const int pieces = degree < 2 ? 1 : kPieces;
  const int n_rows = pieces * degree + 1;  // neighbours share the value between them
  PullConditions conditions{Eigen::MatrixXd(n_rows, order), Eigen::VectorXd(n_rows)};
  for (int piece = 0; piece < pieces; ++piece) {
    conditions.rows.middleRows(piece * degree, degree + 1) =
        bernstein_rows(degree, longest * piece / pieces, longest * (piece + 1) / pieces);
    conditions.at.segment(piece * degree, degree + 1)
        .setLinSpaced(longest * piece / pieces, longest * (piece + 1) / pieces);
  }
  return conditions;
}

}  // namespace

CableLaw polynomial() {
  return {.name = "polynomial",
          .equation = "f = sum_j K_j l^(j+1), j = 0 .. order-1, for l > 0, else 0",
          .source = "Fichera & Grossard 2017, (16)-(18)",
          .max_order = kMaxCableOrder,
          .n_coefficients = n_coefficients,
          .basis = basis,
          .slope = slope,
          .pull_conditions = pull_conditions};
}

}  // namespace cablefit::laws
