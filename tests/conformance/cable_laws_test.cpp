// Every row of the table of cable laws keeps the promises of cables.hpp.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/base/units.hpp"
#include "cablefit/model/cables.hpp"

namespace {

using namespace cablefit;

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
