#include "cablefit/model/cables/laws.hpp"

namespace cablefit::laws {
namespace {

int n_coefficients(int /*order*/) { return 1; }

void basis(int /*order*/, double l, double* values) { values[0] = l; }

void slope(int /*order*/, double /*l*/, double* values) { values[0] = 1.0; }

}  // namespace

CableLaw linear() {
  return {.name = "linear",
          .equation = "f = K_0 l for l > 0, else 0",
          .source = "Fichera & Grossard 2017, (20)",
          .max_order = 1,
          .n_coefficients = n_coefficients,
          .basis = basis,
          .slope = slope};
}

}  // namespace cablefit::laws
