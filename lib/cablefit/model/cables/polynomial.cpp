#include "cablefit/model/cables/bernstein.hpp"
#include "cablefit/model/cables/laws.hpp"

namespace cablefit::laws {
namespace {

int n_coefficients(int order) { return order; }

int length_power(int index) { return index + 1; }

void basis(const LawShape& shape, double l, double* values) {
  double power = l;
  for (int j = 0; j < shape.order; ++j, power *= l) values[j] = power;
}

void slope(const LawShape& shape, double l, double* values) {
  double power = 1.0;
  for (int j = 0; j < shape.order; ++j, power *= l) values[j] = (j + 1) * power;
}

void energy(const LawShape& shape, double l, double* values) {
  double power = l * l;
  for (int j = 0; j < shape.order; ++j, power *= l) values[j] = power / (j + 2);
}

// Bernstein coefficients of k(l) on pieces of the range. Up to order 2 k is a line and its values
// at both ends say it all; beyond, the coefficients are sufficient and come down to the curve with
// the square of the length of a piece (Farin 2002, 5.3).
constexpr int kPieces = 8;

PullConditions pull_conditions(const LawShape& shape, double longest) {
  const int degree = shape.order - 1;
  const int pieces = degree < 2 ? 1 : kPieces;
  const int n_rows = pieces * degree + 1;  // neighbours share the value between them
  PullConditions conditions{Eigen::MatrixXd(n_rows, shape.order), Eigen::VectorXd(n_rows)};
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
          .coefficients = "K_j: any sign as long as f >= 0 in use",
          .max_order = kMaxCableOrder,
          .has_toe = false,
          .n_coefficients = n_coefficients,
          .length_power = length_power,
          .basis = basis,
          .slope = slope,
          .energy = energy,
          .pull_conditions = pull_conditions};
}

}  // namespace cablefit::laws
