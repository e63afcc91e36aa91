#include <algorithm>
#include <array>
#include <vector>

#include "cablefit/model/cables/laws.hpp"

// A force of any shape with a continuous slope: its stiffness is a line between knots at eighths of
// the toe, and constant beyond. The terms are integrals of hat functions (I-splines of order 2,
// Ramsay 1988) in the order of Faber's hierarchical basis (Yserentant 1986), so that a higher order
// only adds:
//
//   f = K_0 l + sum_j K_j w_j S((l - c_j)/w_j),  S' = hat over -1 .. 1
//
// c_1 = w_1 = toe with its rising half only, then c_j = 1/2, 1/4, 3/4, 1/8, ... of toe. Every even
// quadratic spline up to the knots of an order is in it.
namespace cablefit::laws {
namespace {

struct Hat {
  double centre, width;  ///< of the toe
};
constexpr std::array<Hat, kMaxCableOrder - 1> kHats{{{1, 1},
                                                     {0.5, 0.5},
                                                     {0.25, 0.25},
                                                     {0.75, 0.25},
                                                     {0.125, 0.125},
                                                     {0.375, 0.125},
                                                     {0.625, 0.125},
                                                     {0.875, 0.125}}};

int n_coefficients(int order) { return order; }

int length_power(int /*index*/) { return 1; }

/// value(u) of a hat at u widths from its centre, -1 < u; times width^power. The first stays at its
/// top: `beyond`(u) at u > 0.
template <typename Value, typename Beyond>
void fill_hats(const LawShape& shape, double l, double* values, int power, Value value,
               Beyond beyond) {
  for (int j = 1; j < shape.order; ++j) {
    const Hat& hat = kHats.at(static_cast<std::size_t>(j) - 1);
    const double width = hat.width * shape.toe;
    const double u = (l - hat.centre * shape.toe) / width;
    double term = u <= -1 ? 0 : j == 1 && u > 0 ? beyond(u) : value(u);
    for (int k = 0; k < power; ++k) term *= width;
    values[j] = term;
  }
}

void basis(const LawShape& shape, double l, double* values) {
  values[0] = l;
  fill_hats(
      shape, l, values, 1,
      [](double u) {
        return u >= 1 ? 1 : u < 0 ? (1 + u) * (1 + u) / 2 : 1 - (1 - u) * (1 - u) / 2;
      },
      [](double u) { return 0.5 + u; });
}

void slope(const LawShape& shape, double l, double* values) {
  values[0] = 1;
  fill_hats(
      shape, l, values, 0, [](double u) { return u >= 1  ? 0
                                                 : u < 0 ? 1 + u
                                                         : 1 - u; },
      [](double /*u*/) { return 1.0; });
}

void energy(const LawShape& shape, double l, double* values) {
  values[0] = 0.5 * l * l;
  fill_hats(
      shape, l, values, 2,
      [](double u) {
        const double down = 1 - u, up = 1 + u;
        return u >= 1 ? u : u < 0 ? up * up * up / 6 : u + down * down * down / 6;
      },
      [](double u) { return 1.0 / 6 + u * (1 + u) / 2; });
}

// df/dl >= 0 at the knots and at the longest elongation is df/dl >= 0 between them, sufficient for
// k(l) >= 0. A fit that pulls stands as it is.
PullConditions pull_conditions(const LawShape& shape, double longest) {
  std::vector<double> at = {0, longest};
  for (int j = 1; j < shape.order; ++j) {
    const Hat& hat = kHats.at(static_cast<std::size_t>(j) - 1);
    if (hat.centre * shape.toe < longest) at.push_back(hat.centre * shape.toe);
  }
  std::sort(at.begin(), at.end());
  const auto n = static_cast<Eigen::Index>(at.size());
  PullConditions conditions{Eigen::MatrixXd(n, shape.order), Eigen::VectorXd(n)};
  std::vector<double> values(static_cast<std::size_t>(shape.order));
  for (Eigen::Index i = 0; i < n; ++i) {
    conditions.at(i) = at[static_cast<std::size_t>(i)];
    slope(shape, conditions.at(i), values.data());
    for (int j = 0; j < shape.order; ++j)
      conditions.rows(i, j) = values[static_cast<std::size_t>(j)];
  }
  return conditions;
}

}  // namespace

CableLaw spline() {
  return {.name = "spline",
          .equation = "f = K_0 l + sum_j K_j B_j(l) for l > 0, else 0; dB_j/dl: hat about c_j",
          .source = "Ramsay 1988 (I-splines); Yserentant 1986 (order of the terms)",
          .coefficients =
              "K_j, of stiffness about c_j = 1, 1/2, 1/4, 3/4, 1/8, ... of toe: any sign as long "
              "as f >= 0 in use",
          .max_order = kMaxCableOrder,
          .has_toe = true,
          .n_coefficients = n_coefficients,
          .length_power = length_power,
          .basis = basis,
          .slope = slope,
          .energy = energy,
          .pull_conditions = pull_conditions};
}

}  // namespace cablefit::laws
