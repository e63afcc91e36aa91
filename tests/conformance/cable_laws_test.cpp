// Every row of the table of cable laws keeps the promises of cables.hpp.
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/base/units.hpp"
#include "cablefit/model/cables.hpp"
#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using cablefit::test::Normal;

/// Runs `check(cable)` for every law and order, with coefficients of the paper's size.
template <typename Check>
void for_every_cable(Check check) {
  for (const CableLaw& law : cable_laws()) {
    for (int order = 1; order <= law.max_order; ++order) {
      INFO(law.name << " of order " << order);
      Cable cable;
      cable.law = &law;
      cable.order = order;
      cable.toe = law.has_toe ? 0.02 : 0;
      for (int j = 0; j < cable.n_coefficients(); ++j) {
        cable.coefficients.push_back(1500.0 * std::pow(20.0, j));
      }
      check(cable);
    }
  }
}

TEST_CASE("a law's slope is the derivative of its basis", "[conformance]") {
  for_every_cable([](const Cable& cable) {
    const auto n = static_cast<std::size_t>(cable.n_coefficients());
    REQUIRE(n <= static_cast<std::size_t>(kMaxCableOrder));
    std::vector<double> below(n), above(n), slope(n);
    for (const double l : {0.003, 0.012, 0.05, 0.8}) {  // within a toe and beyond
      const double step = 1e-5 * l;
      cable.law->basis(cable.shape(), l - step, below.data());
      cable.law->basis(cable.shape(), l + step, above.data());
      cable.law->slope(cable.shape(), l, slope.data());
      for (std::size_t j = 0; j < n; ++j) {
        // Central differences of l^j: relative error j^2/6 (step/l)^2 <= 1.5e-9, rounding 1e-11.
        const double difference = (above[j] - below[j]) / (2 * step);
        CHECK(std::abs(difference - slope[j]) <= 2e-9 * std::abs(slope[j]));
      }
    }
  });
}

TEST_CASE("a taut cable pulls, a slack one does nothing", "[conformance]") {
  for_every_cable([](const Cable& cable) {
    for (const double slack : {0.0, -1e-9, -0.01, -5.0}) {
      CHECK(cable.force(slack) == 0);
      CHECK(cable.stiffness(slack) == 0);
      CHECK(cable.secant(slack) == 0);
    }
    for (const double l : {1e-9, 0.003, 0.05}) {
      CHECK(cable.force(l) > 0);
      CHECK(cable.stiffness(l) > 0);
      CHECK(cable.secant(l) * l == Approx(cable.force(l)).epsilon(1e-15));
    }
    CHECK(std::abs(cable.force(1e-12)) < 1e-8);  // continuous at the point of going slack
  });
}

TEST_CASE("a law's energy is the integral of its basis", "[conformance]") {
  // Gauss-Legendre with 5 points (Abramowitz & Stegun 25.4.30), exact up to degree 9; on pieces
  // that end at eighths of the toe, between which every basis is a polynomial of degree 9 at most.
  constexpr double kNode[] = {0, 0.53846931010568309, 0.90617984593866399};
  constexpr double kWeight[] = {0.56888888888888889, 0.47862867049936647, 0.23692688505618909};
  for_every_cable([&](const Cable& cable) {
    const auto n = static_cast<std::size_t>(cable.n_coefficients());
    std::vector<double> basis(n), energy(n), sum(n, 0.0);
    constexpr double kPiece = 0.0025;
    for (int piece = 0; piece < 24; ++piece) {
      for (int i = -2; i <= 2; ++i) {
        const double node = std::copysign(kNode[std::abs(i)], i);
        cable.law->basis(cable.shape(), kPiece * (piece + 0.5 + 0.5 * node), basis.data());
        for (std::size_t j = 0; j < n; ++j)
          sum[j] += 0.5 * kPiece * kWeight[std::abs(i)] * basis[j];
      }
      cable.law->energy(cable.shape(), kPiece * (piece + 1), energy.data());
      // A term that begins where the piece ends: rounding of its argument, cubed.
      constexpr double kNothing = 1e-45;
      for (std::size_t j = 0; j < n; ++j)
        CHECK(std::abs(energy[j] - sum[j]) <= 1e-13 * sum[j] + kNothing);
    }
  });
}

TEST_CASE("a law of higher order only adds to one of lower order", "[conformance]") {
  for_every_cable([](const Cable& cable) {
    Cable largest = cable;
    largest.order = cable.law->max_order;
    std::vector<double> some(static_cast<std::size_t>(cable.n_coefficients()));
    std::vector<double> all(static_cast<std::size_t>(largest.n_coefficients()));
    for (const double l : {0.001, 0.012, 0.05}) {
      cable.law->basis(cable.shape(), l, some.data());
      cable.law->basis(largest.shape(), l, all.data());
      CHECK(std::equal(some.begin(), some.end(), all.begin()));
    }
  });
}

TEST_CASE("no basis is negative or falls, and no two are alike", "[conformance]") {
  for_every_cable([](const Cable& cable) {
    const auto n = cable.n_coefficients();
    constexpr int kPoints = 300;
    Eigen::MatrixXd basis(n, kPoints);
    Eigen::VectorXd slope(n);
    for (int i = 0; i < kPoints; ++i) {
      const double l = 0.06 * (i + 1) / kPoints;
      cable.law->basis(cable.shape(), l, basis.col(i).data());
      cable.law->slope(cable.shape(), l, slope.data());
      CHECK(basis.col(i).minCoeff() >= 0);
      CHECK(slope.minCoeff() >= 0);
    }
    for (int j = 0; j < n; ++j) basis.row(j).normalize();
    CHECK(Eigen::FullPivLU<Eigen::MatrixXd>(basis).rank() == n);
  });
}

TEST_CASE("a strand has a soft toe without a corner, and is linear beyond") {
  Cable cable;
  cable.law = &find_cable_law("strand");
  cable.order = 4;
  cable.toe = 0.02;
  cable.coefficients = {100, 200, 50, 30};
  CHECK(cable.stiffness(1e-9) < 1e-5);  // 100 N/m times 1e-9/0.02
  for (const double l : {0.005, 0.01, 0.015, 0.02}) {
    // Slopes change by at most sum K_j / (toe/4) = 76000 N/m^2.
    CHECK(std::abs(cable.stiffness(l + 1e-9) - cable.stiffness(l - 1e-9)) < 76000 * 2e-9);
  }
  CHECK(cable.stiffness(0.021) == Approx(380).epsilon(1e-12));
  CHECK(cable.force(0.05) - cable.force(0.04) == Approx(3.8).epsilon(1e-12));
  cable.order = 1;
  cable.coefficients = {100};
  CHECK(cable.force(0.01) == Approx(100 * 0.01 * 0.01 / 0.04).epsilon(1e-12));
  CHECK(cable.force(0.05) == Approx(100 * (0.05 - 0.01)).epsilon(1e-12));
}

TEST_CASE("a spline's stiffness is a line between knots, of any heights") {
  Cable cable;
  cable.law = &find_cable_law("spline");
  cable.order = cable.law->max_order;
  cable.toe = 0.04;
  // Heights at the knots 0, toe/8, ..., toe, and the coefficients that have them.
  Eigen::VectorXd heights(9);
  heights << 3600, 3650, 2116, 2200, 2300, 0, 2500, 2600, 2700;
  Eigen::MatrixXd slopes(9, 9);
  for (int i = 0; i < 9; ++i) {
    Eigen::VectorXd values(9);
    cable.law->slope(cable.shape(), 0.005 * i, values.data());
    slopes.row(i) = values;
  }
  const Eigen::VectorXd x = slopes.fullPivLu().solve(heights);
  cable.coefficients.assign(x.begin(), x.end());
  double force = 0;
  for (int i = 0; i < 8; ++i) {
    CHECK(cable.stiffness(0.005 * (i + 0.3)) ==
          Approx(0.7 * heights(i) + 0.3 * heights(i + 1)).epsilon(1e-9).margin(1e-6));
    force += 0.005 * (heights(i) + heights(i + 1)) / 2;  // trapezoids
    CHECK(cable.force(0.005 * (i + 1)) == Approx(force).epsilon(1e-12));
  }
  CHECK(cable.stiffness(0.07) == Approx(2700).epsilon(1e-9));  // constant beyond the toe
  // The conditions are the heights, up to the elongation in use.
  const PullConditions pull = cable.law->pull_conditions(cable.shape(), 0.017);
  CHECK(pull.at.size() == 5);
  CHECK((pull.rows * x).minCoeff() == Approx(2116).epsilon(1e-9));
}

TEST_CASE("stretching and releasing a cable costs no energy", "[conformance]") {
  for_every_cable([](const Cable& cable) {
    // Trapezoidal rule over a closed path l(s): on the way back every force is met again.
    constexpr int kSteps = 1000;
    double work = 0, largest = 0, l_before = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const double l = 0.04 * std::sin(2 * M_PI * i / kSteps);
      work += 0.5 * (cable.force(l) + cable.force(l_before)) * (l - l_before);
      largest = std::max(largest, cable.force(l) * 0.04);
      l_before = l;
    }
    CHECK(std::abs(work) <= 1e-12 * largest);
  });
}

/// The conditions ask that the force never falls, which is more than that the cable pulls.
bool is_of_slope(const Cable& cable, const PullConditions& pull) {
  Eigen::VectorXd slope(pull.rows.cols());
  for (Eigen::Index i = 0; i < pull.rows.rows(); ++i) {
    cable.law->slope(cable.shape(), pull.at(i), slope.data());
    if (slope.transpose() != pull.rows.row(i)) return false;
  }
  return true;
}

/// Least df/dl of many elongations: just taut, and at places that hold the knots of every law,
/// which are eighths of the toe.
double least_stiffness(Cable cable, const Eigen::VectorXd& coefficients, double longest) {
  constexpr int kPlaces = 512;
  cable.coefficients.assign(coefficients.begin(), coefficients.end());
  double least = cable.stiffness(1e-9 * longest);
  for (int i = 1; i <= kPlaces; ++i)
    least = std::min(least, cable.stiffness(longest * i / kPlaces));
  return least;
}

/// Least k(l) of many elongations; `share`: of the size of its terms, by which rounding is judged.
double least_secant(Cable cable, const Eigen::VectorXd& coefficients, double longest, bool share) {
  cable.coefficients.assign(coefficients.begin(), coefficients.end());
  Cable sizes = cable;
  for (double& c : sizes.coefficients) c = std::abs(c);
  double least = kUnbounded;
  for (int i = 1; i <= 500; ++i) {
    const double l = longest * i / 500;
    least = std::min(least, cable.secant(l) / (share ? sizes.secant(l) : 1));
  }
  return least;
}

TEST_CASE("coefficients that meet the pull conditions make a cable that only pulls",
          "[conformance]") {
  Normal normal(900);
  for_every_cable([&](const Cable& cable) {
    const double longest = 0.04;
    const PullConditions pull = cable.law->pull_conditions(cable.shape(), longest);
    const Eigen::Index n = cable.n_coefficients();
    REQUIRE(pull.rows.cols() == n);
    REQUIRE(pull.at.size() == pull.rows.rows());
    CHECK(pull.at.minCoeff() >= 0);
    CHECK(pull.at.maxCoeff() <= longest * (1 + 1e-15));
    Eigen::VectorXd stiff(n);  // certainly pulls
    for (Eigen::Index j = 0; j < n; ++j)
      stiff(j) = std::pow(longest, 1 - cable.law->length_power(static_cast<int>(j)));
    const Eigen::ArrayXd lift = (pull.rows * stiff).array();
    REQUIRE(lift.minCoeff() > 0);
    const bool of_slope = is_of_slope(cable, pull);
    double least = kUnbounded, most_beyond = -kUnbounded;
    for (int run = 0; run < 200; ++run) {
      // On the edge of what the conditions allow: any direction, lifted until the worst just holds.
      Eigen::VectorXd c = stiff;
      for (double& value : c) value *= 1000 * normal();
      c -= ((pull.rows * c).array() / lift).minCoeff() * stiff;
      least = std::min(least, least_secant(cable, c, longest, true));
      const Eigen::VectorXd beyond = c - 100 * stiff;
      most_beyond = std::max(most_beyond, of_slope ? least_stiffness(cable, beyond, longest)
                                                   : least_secant(cable, beyond, longest, false));
    }
    CHECK(least >= -1e-13);  // a hundred roundings
    // Hardly more than needed: a tenth of the coefficients' size beyond, each of them pushes, or
    // its force falls where the conditions ask that it does not. (Where every coefficient is bound
    // by itself it means something by itself: more is asked.)
    if (n == 1 || !pull.rows.isIdentity()) CHECK(most_beyond < 0);
  });
}

// k(l) of order 2 is a line: conditions at its ends, and nothing but them.
TEST_CASE("a second-order cable pulls when it does at both ends", "[conformance]") {
  const PullConditions pull = find_cable_law("polynomial").pull_conditions({2, 0}, 0.0138);
  Eigen::Matrix2d expected;
  expected << 1, 0, 1, 0.0138;
  CHECK(pull.rows == expected);
  CHECK(pull.at == Eigen::Vector2d(0, 0.0138));
}

TEST_CASE("a law says what it is", "[conformance]") {
  for (const CableLaw& law : cable_laws()) {
    INFO(law.name);
    CHECK_FALSE(law.name.empty());
    CHECK_FALSE(law.equation.empty());
    CHECK_FALSE(law.source.empty());
    CHECK_FALSE(law.coefficients.empty());
    CHECK(law.max_order <= kMaxCableOrder);
    CHECK(law.max_order >= 1);
    CHECK(&find_cable_law(law.name) == &law);
  }
  CHECK_THROWS_WITH(find_cable_law("polinomial"),
                    "unknown cable law 'polinomial'; did you mean 'polynomial'?");
}

TEST_CASE("units of coefficients are force over length to the power", "[conformance]") {
  for_every_cable([](const Cable& cable) {
    for (int j = 0; j < cable.n_coefficients(); ++j) {
      const std::string joint_space = coefficient_unit(*cable.law, j, false);
      const std::string cable_space = coefficient_unit(*cable.law, j, true);
      INFO(joint_space << ", " << cable_space);
      CHECK(parse_unit(joint_space).dimension == parse_unit("N m").dimension);
      CHECK(parse_unit(cable_space).dimension[0] == 1 - cable.law->length_power(j));
      CHECK(unit_for(Axes::linear, joint_space) == cable_space);
    }
    // The power is how the basis grows when every length of the law doubles, without rounding.
    std::vector<double> basis(static_cast<std::size_t>(cable.n_coefficients()));
    auto doubled = basis;
    LawShape twice = cable.shape();
    twice.toe *= 2;
    for (const double l : {0.003, 0.011, 0.05, 1e3}) {
      cable.law->basis(cable.shape(), l, basis.data());
      cable.law->basis(twice, 2 * l, doubled.data());
      for (std::size_t j = 0; j < basis.size(); ++j)
        CHECK(doubled[j] == std::ldexp(basis[j], cable.law->length_power(static_cast<int>(j))));
    }
  });
}

}  // namespace
