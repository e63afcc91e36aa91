#include "cablefit/model/cables/laws.hpp"

namespace cablefit::laws {
namespace {

int n_coefficients(int /*order*/) { return 1; }

int length_power(int /*index*/) { return 1; }

void basis(const LawShape& /*shape*/, double l, double* values) { values[0] = l; }

void slope(const LawShape& /*shape*/, double /*l*/, double* values) { values[0] = 1.0; }

void energy(const LawShape& /*shape*/, double l, double* values) { values[0] = 0.5 * l * l; }

// k(l) = K_0 everywhere.
PullConditions pull_conditions(const LawShape& /*shape*/, double /*longest*/) {
  return {Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Zero(1)};
}

}  // namespace

CableLaw linear() {
  return {.name = "linear",
          .equation = "f = K_0 l for l > 0, else 0",
          .source = "Fichera & Grossard 2017, (20)",
          .coefficients = "K_0: stiffness, >= 0",
          .max_order = 1,
          .has_toe = false,
          .n_coefficients = n_coefficients,
          .length_power = length_power,
          .basis = basis,
          .slope = slope,
          .energy = energy,
          .pull_conditions = pull_conditions};
}

}  // namespace cablefit::laws
