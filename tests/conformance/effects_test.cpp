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
#include "cablefit/simulate/axis.hpp"

namespace {

using namespace cablefit;

constexpr Eigen::Index kRows = 200;

Estimate with_value(const ParameterInfo& info, double value) {
  Estimate e;
  e.name = info.name;
  e.value = value;
  return e;
}

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

std::string label(const Effect& effect) {
  return std::string(effect.name) + " of the " + std::string(to_string(effect.site));
}

TEST_CASE("a base effect's column is what the simulation does", "[conformance]") {
  const RandomMotion motion(1);
  for (const Effect& effect : base_effects()) {
    INFO(label(effect));
    REQUIRE(effect.parameters.size() == 1);
    Eigen::VectorXd column(kRows);
    fill_base_column(effect, motion.view(), column);
    const Axis axis({{&effect, {with_value(effect.parameters.front(), 1)}}});
    const Axis::Friction& f = axis.friction();
    for (Eigen::Index i = 0; i < kRows; ++i)
      CHECK(column(i) == f.constant + f.damping * motion.velocity(i) +
                             f.level * motion.direction(i) +
                             axis.inertia() * motion.acceleration(i));
  }
}

TEST_CASE("the torque of base effects is that of their columns", "[conformance]") {
  const RandomMotion motion(2);
  std::vector<EffectInstance> effects;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kRows), column(kRows);
  for (const Effect& effect : base_effects(Side::motor)) {
    const double value = 0.3 + static_cast<double>(effects.size());
    effects.push_back({&effect, {with_value(effect.parameters.front(), value)}});
    fill_base_column(effect, motion.view(), column);
    sum += value * column;
  }
  CHECK((base_torque(effects, motion.view()) - sum).cwiseAbs().maxCoeff() <= 1e-14);
  CHECK(inertia_of(effects) == 0.3);
}

TEST_CASE("a base effect says what it is", "[conformance]") {
  std::set<std::string> labels;
  for (const Effect& effect : base_effects()) {
    INFO(label(effect));
    CHECK(labels.insert(label(effect)).second);
    CHECK_FALSE(effect.name.empty());
    CHECK_FALSE(effect.equation.empty());
    CHECK_FALSE(effect.source.empty());
    for (const ParameterInfo& info : effect.parameters) {
      INFO(info.name);
      CHECK_FALSE(info.symbol.empty());
      CHECK_FALSE(info.meaning.empty());
      CHECK(info.lower < info.upper);
      CHECK(effect.equation.find(info.name) != std::string_view::npos);
    }
  }
}

TEST_CASE("parameter names of one side's base effects are unique", "[conformance]") {
  for (const Side side : {Side::link, Side::motor, Side::rigid}) {
    std::set<std::string_view> names;
    for (const Effect& effect : base_effects(side))
      CHECK(names.insert(effect.parameters.front().name).second);
  }
}

TEST_CASE("units of parameters have a linear counterpart", "[conformance]") {
  constexpr std::size_t kMetre = 0;
  for (const Effect& effect : base_effects()) {
    for (const ParameterInfo& info : effect.parameters) {
      INFO(info.name << " in " << info.unit);
      // The radian counts as 1, so a rotary unit has two metres more per torque and inertia and one
      // metre less per angle below the line; the other exponents are those of the linear one.
      const Dimension rotary = parse_unit(info.unit).dimension;
      const Dimension linear = parse_unit(unit_for(Axes::linear, info.unit)).dimension;
      CHECK(unit_for(Axes::linear, info.unit).find("rad") == std::string::npos);
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

TEST_CASE("effects are found by name, and suggested for the rest", "[conformance]") {
  for (const Side side : {Side::link, Side::motor, Side::rigid})
    for (const Effect& effect : base_effects(side))
      CHECK(&find_base_effect(effect.name, side) == &effect);
  for (const Effect& effect : candidate_effects())
    CHECK(&find_candidate(effect.name, effect.site) == &effect);
  CHECK_THROWS_WITH(find_base_effect("viscos", Side::link),
                    "unknown effect 'viscos' of the link; did you mean 'viscous'?");
  CHECK_THROWS_WITH(find_base_effect("offset", Side::link),
                    "unknown effect 'offset' of the link; known: inertia, viscous, coulomb");
}

}  // namespace
