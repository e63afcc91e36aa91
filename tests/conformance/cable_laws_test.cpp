// Every row of the table of cable laws keeps the promises of cables.hpp.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

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
    for (const double l : {0.003, 0.05, 0.8}) {
      const double step = 1e-5 * l;
      cable.law->basis(cable.order, l - step, below.data());
      cable.law->basis(cable.order, l + step, above.data());
      cable.law->slope(cable.order, l, slope.data());
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
    const PullConditions pull = cable.law->pull_conditions(cable.order, longest);
    const Eigen::Index n = cable.n_coefficients();
    REQUIRE(pull.rows.cols() == n);
    REQUIRE(pull.at.size() == pull.rows.rows());
    CHECK(pull.at.minCoeff() >= 0);
    CHECK(pull.at.maxCoeff() <= longest * (1 + 1e-15));
    Eigen::VectorXd stiff(n);  // certainly pulls
    for (Eigen::Index j = 0; j < n; ++j) stiff(j) = std::pow(longest, -static_cast<double>(j));
    const Eigen::ArrayXd lift = (pull.rows * stiff).array();
    REQUIRE(lift.minCoeff() > 0);
    double least = kUnbounded, most_beyond = -kUnbounded;
    for (int run = 0; run < 200; ++run) {
      // On the edge of what the conditions allow: any direction, lifted until the worst just holds.
      Eigen::VectorXd c = stiff;
      for (double& value : c) value *= 1000 * normal();
      c -= ((pull.rows * c).array() / lift).minCoeff() * stiff;
      least = std::min(least, least_secant(cable, c, longest, true));
      most_beyond = std::max(most_beyond, least_secant(cable, c - 100 * stiff, longest, false));
    }
    CHECK(least >= -1e-13);  // a hundred roundings
    // Hardly more than needed: a tenth of the coefficients' size beyond, each of them pushes.
    CHECK(most_beyond < 0);
  });
}

// k(l) of order 2 is a line: conditions at its ends, and nothing but them.
TEST_CASE("a second-order cable pulls when it does at both ends", "[conformance]") {
  const PullConditions pull = find_cable_law("polynomial").pull_conditions(2, 0.0138);
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
    CHECK(law.max_order >= 1);
    CHECK(&find_cable_law(law.name) == &law);
  }
  CHECK_THROWS_WITH(find_cable_law("polinomial"),
                    "unknown cable law 'polinomial'; did you mean 'polynomial'?");
}

TEST_CASE("units of coefficients are force over length to the power", "[conformance]") {
  for (int j = 0; j < kMaxCableOrder; ++j) {
    const std::string joint_space = coefficient_unit(j, false);
    const std::string cable_space = coefficient_unit(j, true);
    INFO(joint_space << ", " << cable_space);
    CHECK(parse_unit(joint_space).dimension == parse_unit("N m").dimension);
    CHECK(parse_unit(cable_space).dimension[0] == 1 - (j + 1));
    CHECK(linear_unit(joint_space) == cable_space);
  }
}

}  // namespace
