#include "cablefit/model/cables/laws.hpp"

namespace cablefit::laws {
namespace {

int n_coefficients(int /*order*/) { return 1; }

void basis(int /*order*/, double l, double* values) { values[0] = l; }

void slope(int /*order*/, double /*l*/, double* values) { values[0] = 1.0; }

// k(l) = K_0 everywhere.
PullConditions pull_conditions(int /*order*/, double /*longest*/) {
  return {Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Zero(1)};
}

}  // namespace

CableLaw linear() {
  return {.name = "linear",
          .equation = "f = K_0 l for l > 0, else 0",
          .source = "Fichera & Grossard 2017, (20)",
          .max_order = 1,
          .n_coefficients = n_coefficients,
          .basis = basis,
          .slope = slope,
          .pull_conditions = pull_conditions};
}

}  // namespace cablefit::laws
