// Every row of the table of effects keeps the promises of effects.hpp.
#include "cablefit/model/effects.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/base/units.hpp"

namespace {

using namespace cablefit;

constexpr Eigen::Index kRows = 200;

/// A random motion with some samples at rest.
struct RandomMotion {
  Eigen::ArrayXd position, velocity, acceleration, direction;

  explicit RandomMotion(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(-2, 2);
    const auto random = [&] { return uniform(engine); };
    position = Eigen::ArrayXd::NullaryExpr(kRows, random);
    velocity = Eigen::ArrayXd::NullaryExpr(kRows, random);
    acceleration = Eigen::ArrayXd::NullaryExpr(kRows, random);
    velocity.head(10).setZero();
    direction = velocity.sign();
  }
  Motion view() const { return {position, velocity, acceleration, direction}; }
};

/// What the simulation functions say about one sample.
double simulated_torque(const Effect& effect, const RandomMotion& motion, Eigen::Index i,
                        const double* parameters) {
  double torque = 0;
  if (effect.smooth) torque += effect.smooth(motion.position[i], motion.velocity[i], parameters);
  if (effect.dry) {
    torque += effect.dry(motion.position[i], motion.velocity[i], parameters) * motion.direction[i];
  }
  if (effect.inertia) torque += effect.inertia(parameters) * motion.acceleration[i];
  return torque;
}

std::string label(const Effect& effect) {
  return std::string(effect.name) + " on the " + std::string(to_string(effect.side)) + " side";
}

TEST_CASE("an effect's regressor is what the simulation does", "[conformance]") {
  for (const Effect& effect : effects()) {
    INFO(label(effect));
    const auto n_params = effect.n_linear();
    const RandomMotion motion(1);
    Eigen::MatrixXd columns(kRows, static_cast<Eigen::Index>(n_params));
    columns.setConstant(std::nan(""));
    effect.regressor(motion.view(), columns);
    for (std::size_t p = 0; p < n_params; ++p) {
      std::vector<double> unit(n_params, 0.0);
      unit[p] = 1.0;
      unit.insert(unit.end(), effect.shape.begin(), effect.shape.end());
      for (Eigen::Index i = 0; i < kRows; ++i) {
        // One product of numbers up to 2: rounding alone.
        CHECK(std::abs(columns(i, static_cast<Eigen::Index>(p)) -
                       simulated_torque(effect, motion, i, unit.data())) <= 1e-14);
      }
    }
  }
}

TEST_CASE("an effect called affine is affine", "[conformance]") {
  for (const Effect& effect : effects()) {
    if (!effect.is_affine) continue;
    INFO(label(effect));
    const std::vector<double> parameters(effect.parameters.size(), 1.7);
    const RandomMotion motion(2);
    for (Eigen::Index i = 0; i < kRows; ++i) {
      const double x = motion.position[i], v = motion.velocity[i];
      if (effect.smooth) {
        const double at_rest = effect.smooth(0, 0, parameters.data());
        const double slope = effect.smooth(0, 1, parameters.data()) - at_rest;
        CHECK(std::abs(effect.smooth(x, v, parameters.data()) - at_rest - slope * v) <= 1e-14);
      }
      if (effect.dry)
        CHECK(effect.dry(x, v, parameters.data()) == effect.dry(0, 0, parameters.data()));
    }
  }
}

TEST_CASE("the level of dry friction is not negative within the bounds", "[conformance]") {
  for (const Effect& effect : effects()) {
    if (!effect.dry) continue;
    INFO(label(effect));
    std::vector<double> parameters;
    for (const ParameterInfo& info : effect.parameters) {
      parameters.push_back(std::isfinite(info.lower) ? info.lower + 0.5 : 0.5);
    }
    const RandomMotion motion(3);
    for (Eigen::Index i = 0; i < kRows; ++i) {
      CHECK(effect.dry(motion.position[i], motion.velocity[i], parameters.data()) >= 0);
    }
  }
}

/// Parameters inside the bounds, all different.
std::vector<double> some_parameters(const Effect& effect) {
  std::vector<double> parameters;
  for (std::size_t k = 0; k < effect.parameters.size(); ++k)
    parameters.push_back(std::max(0.0, effect.parameters[k].lower) + 0.3 +
                         0.2 * static_cast<double>(k));
  return parameters;
}

using TorqueFunction = double (*)(double, double, const double*);

/// Central difference of one argument of `torque`: 0 position, 1 velocity, from 2 on a parameter.
double central_slope(TorqueFunction torque, double x, double v, std::vector<double> parameters,
                     std::size_t argument) {
  constexpr double kStep = 1e-5;
  const auto at = [&](double step) {
    if (argument > 1) {
      std::vector<double> moved = parameters;
      moved[argument - 2] += step;
      return torque(x, v, moved.data());
    }
    return torque(x + (argument == 0 ? step : 0), v + (argument == 1 ? step : 0),
                  parameters.data());
  };
  return (at(kStep) - at(-kStep)) / (2 * kStep);
}

void check_slopes(const Effect& effect, TorqueFunction torque,
                  double (*slopes_of)(double, double, const double*, double*)) {
  REQUIRE((torque == nullptr) == (slopes_of == nullptr));
  if (!torque) return;
  const std::vector<double> parameters = some_parameters(effect);
  const RandomMotion motion(4);
  std::vector<double> slopes(parameters.size() + 2);
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const double x = motion.position[i], v = motion.velocity[i];
    std::fill(slopes.begin(), slopes.end(), std::nan(""));
    CHECK(slopes_of(x, v, parameters.data(), slopes.data()) == torque(x, v, parameters.data()));
    // Central differences: h^2 / 6 of a third derivative up to 100, rounding 1e-16 / h.
    for (std::size_t k = 0; k < slopes.size(); ++k)
      CHECK(std::abs(slopes[k] - central_slope(torque, x, v, parameters, k)) <= 1e-8);
  }
}

TEST_CASE("an effect's slopes are those of its torque", "[conformance]") {
  for (const Effect& effect : effects()) {
    INFO(label(effect));
    check_slopes(effect, effect.smooth, effect.smooth_slopes);
    check_slopes(effect, effect.dry, effect.dry_slopes);
    REQUIRE((effect.inertia == nullptr) == (effect.inertia_slopes == nullptr));
    if (!effect.inertia) continue;
    std::vector<double> parameters = some_parameters(effect), slopes(parameters.size());
    effect.inertia_slopes(parameters.data(), slopes.data());
    const double before = effect.inertia(parameters.data());
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      std::vector<double> moved = parameters;
      moved[k] += 1;  // an inertia is linear in its parameters
      CHECK_THAT(slopes[k], Catch::WithinAbs(effect.inertia(moved.data()) - before, 1e-14));
    }
  }
}

TEST_CASE("an effect says what it is", "[conformance]") {
  std::set<std::string> labels;
  for (const Effect& effect : effects()) {
    INFO(label(effect));
    CHECK(labels.insert(label(effect)).second);
    CHECK_FALSE(effect.name.empty());
    CHECK_FALSE(effect.equation.empty());
    CHECK_FALSE(effect.source.empty());
    REQUIRE_FALSE(effect.parameters.empty());
    for (const ParameterInfo& info : effect.parameters) {
      INFO(info.name);
      CHECK_FALSE(info.symbol.empty());
      CHECK_FALSE(info.meaning.empty());
      CHECK(info.lower < info.upper);
      CHECK(effect.equation.find(info.name) != std::string_view::npos);
    }
  }
}

// Except of two laws of the same thing, which never stand together.
TEST_CASE("parameter names of one side are unique", "[conformance]") {
  for (const Side side : {Side::link, Side::motor, Side::rigid}) {
    std::set<std::string_view> names;
    for (const Effect& effect : effects()) {
      if (effect.side != side) continue;
      if (!effect.instead_of.empty()) {
        CHECK_FALSE(find_effect(effect.instead_of, side).parameters.empty());
        continue;
      }
      for (const ParameterInfo& info : effect.parameters) CHECK(names.insert(info.name).second);
    }
  }
}

TEST_CASE("units of parameters have a linear counterpart", "[conformance]") {
  constexpr std::size_t kMetre = 0;
  for (const Effect& effect : effects()) {
    for (const ParameterInfo& info : effect.parameters) {
      INFO(info.name << " in " << info.unit);
      // The radian counts as 1, so a rotary unit has two metres more per torque and inertia and one
      // metre less per angle below the line; the other exponents are those of the linear one.
      const Dimension rotary = parse_unit(info.unit).dimension;
      const Dimension linear = parse_unit(linear_unit(info.unit)).dimension;
      CHECK(linear_unit(info.unit).find("rad") == std::string::npos);
      CHECK(linear[kMetre] != rotary[kMetre]);
      for (std::size_t base = 1; base < rotary.size(); ++base) CHECK(linear[base] == rotary[base]);
    }
  }
}

TEST_CASE("the paper's model is (14) and (31)", "[conformance]") {
  const auto names = [](Side side) {
    std::string text;
    for (const Effect& effect : base_effects(side)) {
      for (const ParameterInfo& info : effect.parameters) text += std::string(info.name) + " ";
    }
    return text;
  };
  CHECK(names(Side::link) == "J_link f_v f_s ");
  CHECK(names(Side::motor) == "J_motor f_vm f_sm offset ");
  CHECK(names(Side::rigid) == "J f_v f_s offset ");
}

TEST_CASE("find_effect finds every row and suggests for the rest", "[conformance]") {
  for (const Effect& effect : effects()) CHECK(&find_effect(effect.name, effect.side) == &effect);
  CHECK_THROWS_WITH(find_effect("viscos", Side::link),
                    "unknown effect 'viscos' on the link side; did you mean 'viscous'?");
  CHECK_THROWS_WITH(find_effect("offset", Side::link),
                    "unknown effect 'offset' on the link side; known: inertia, viscous, coulomb, "
                    "smooth_coulomb");
}

}  // namespace
