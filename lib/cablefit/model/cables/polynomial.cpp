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
          .energy = energy};
}

}  // namespace cablefit::laws
