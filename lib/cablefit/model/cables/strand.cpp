#include <array>

#include "cablefit/model/cables/laws.hpp"

// A stranded cable bears with more of its wires the further it is stretched: wires (or groups of
// them) straighten and settle one after the other, until all of them bear at the end of the toe and
// the cable is linear. Group j starts to bear at a_j and grows evenly until the end of the toe, so
// its stiffness is a ramp, and its force the ramp's integral:
//
//   f = sum_j K_j B_j(l),  B_j' = 0 below a_j, (l - a_j)/(toe - a_j) up to the toe, 1 beyond
//
// Order 1 is the quadratic toe with a linear end of ligament models; together the B_j span every
// force whose slope is continuous, piecewise linear between the a_j and constant beyond the toe.
// The start points are fixed, so that the law is linear in K and no two columns are alike. K_j >= 0
// is a cable that pulls, and stiffens until the toe ends, where its stiffness is the sum of K_j.
//
// Blankevoort & Huiskes, Ligament-bone interaction in a three-dimensional model of the knee, J.
// Biomech. Eng. 113 (1991): order 1, with a toe of 2 epsilon_l. Friedman, Multivariate adaptive
// regression splines, Ann. Statist. 19 (1991): hinges as a basis.
namespace cablefit::laws {
namespace {

/// a_j / toe: each new one halves the widest gap, so a higher order only adds.
constexpr std::array<double, 4> kStart{0.0, 0.5, 0.25, 0.75};

int n_coefficients(int order) { return order; }

int length_power(int /*index*/) { return 1; }

/// value(u, w): of a ramp at u > 0 beyond its start, w wide.
template <typename Value>
void fill(const LawShape& shape, double l, double* values, Value value) {
  for (int j = 0; j < shape.order; ++j) {
    const double start = kStart.at(static_cast<std::size_t>(j)) * shape.toe;
    values[j] = l > start ? value(l - start, shape.toe - start) : 0.0;
  }
}

void basis(const LawShape& shape, double l, double* values) {
  fill(shape, l, values, [](double u, double w) { return u < w ? u * u / (2 * w) : u - w / 2; });
}

void slope(const LawShape& shape, double l, double* values) {
  fill(shape, l, values, [](double u, double w) { return u < w ? u / w : 1.0; });
}

void energy(const LawShape& shape, double l, double* values) {
  fill(shape, l, values, [](double u, double w) {
    return u < w ? u * u * u / (6 * w) : u * (u - w) / 2 + w * w / 6;
  });
}

// Every group of wires pulls: sufficient, and stiffer than k >= 0 asks. A fit that pulls as a whole
// stands as it is, though strongly correlated groups share out their K_j with either sign.
PullConditions pull_conditions(const LawShape& shape, double /*longest*/) {
  PullConditions conditions{Eigen::MatrixXd::Identity(shape.order, shape.order),
                            Eigen::VectorXd(shape.order)};
  for (int j = 0; j < shape.order; ++j)
    conditions.at(j) = kStart.at(static_cast<std::size_t>(j)) * shape.toe;
  return conditions;
}

}  // namespace

CableLaw strand() {
  return {
      .name = "strand",
      .equation = "f = sum_j K_j B_j(l) for l > 0, else 0; dB_j/dl: ramp from 0 at a_j to 1 at toe",
      .source = "Blankevoort & Huiskes 1991 (order 1); hinge functions: Friedman 1991",
      .coefficients =
          "K_j, of what bears from a_j = 0, 1/2, 1/4, 3/4 of toe on: any sign as long as f >= 0 in "
          "use",
      .max_order = static_cast<int>(kStart.size()),
      .has_toe = true,
      .n_coefficients = n_coefficients,
      .length_power = length_power,
      .basis = basis,
      .slope = slope,
      .energy = energy,
      .pull_conditions = pull_conditions};
}

}  // namespace cablefit::laws
