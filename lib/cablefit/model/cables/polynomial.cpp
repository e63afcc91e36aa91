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

}  // namespace

CableLaw polynomial() {
  return {.name = "polynomial",
          .equation = "f = sum_j K_j l^(j+1), j = 0 .. order-1, for l > 0, else 0",
          .source = "Fichera & Grossard 2017, (16)-(18)",
          .max_order = kMaxCableOrder,
          .n_coefficients = n_coefficients,
          .basis = basis,
          .slope = slope};
}

}  // namespace cablefit::laws
