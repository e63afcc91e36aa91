// Friction against the preload: from models with friction that is known to follow the tension, and
// from simulated logs of three preloads.
#include "cablefit/design/friction_curves.hpp"

#include <cmath>
#include <cstdio>

#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "tests/identify/simulated_rigs.hpp"
#include "tests/simulate/benches.hpp"
#include "tests/support/message.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;
using Catch::Matchers::WithinRel;

constexpr double kFirst = 1400, kSecond = 1600;  // N m/rad
constexpr double kExact = 1e-9;

/// Linear cables at this preload, where the tensions sum to 2 kFirst l_o.
Model fit_at(const std::string& preload, double l_o, double f_s, double f_sm) {
  Model model = spring_joint({0.3, 5, f_s}, {0.01, 1, f_sm, 0}, 0);
  model.preload = preload;
  model.transmission = antagonist_pair(1);
  model.transmission.cables[0].coefficients = {kFirst};
  model.transmission.cables[1].coefficients = {kSecond};
  model.transmission = with_preload(model.transmission, l_o);
  model.covariance.parameters = {"f_s", "f_sm"};
  model.covariance.matrix = Eigen::Vector2d(0.03 * 0.03, 0.04 * 0.04).asDiagonal();
  return model;
}

/// f_s = 3 + 0.2 tension, f_sm = 2 + 0.05 tension.
Model tension_fit(const std::string& preload, double l_o) {
  const double tension = 2 * kFirst * l_o;
  return fit_at(preload, l_o, 3 + 0.2 * tension, 2 + 0.05 * tension);
}

DesignResult sweep(const std::vector<Model>& fitted, const std::vector<double>& l_o) {
  DesignOptions options;
  options.torque = 40;
  options.l_o = l_o;
  options.fitted = fitted;
  return sweep_design(fitted.front(), options);
}

const DesignJoint& joint_at(const DesignResult& result, double l_o) {
  for (const DesignPoint& point : result.points)
    if (!point.is_own && point.l_o == l_o) return point.joints.front();
  FAIL("no such preload");
  return result.points.front().joints.front();
}

TEST_CASE("friction between two fitted preloads follows their line", "[design]") {
  const std::vector<Model> fitted = {tension_fit("low", 0.002), tension_fit("high", 0.01)};
  const DesignResult result = sweep(fitted, {0.004, 0.0115, 0.012, 0.0003});
  const FrictionCurve* f_s = find_curve(result.friction, 0, "f_s");
  REQUIRE(f_s != nullptr);
  REQUIRE(f_s->line);
  CHECK(f_s->by_tension);
  CHECK_THAT(f_s->line->slope, WithinRel(0.2, kExact));
  CHECK_THAT(f_s->line->intercept(), WithinRel(3.0, kExact));
  const double tension = 2 * kFirst * 0.004, dry = 5 + 0.25 * tension;
  const DesignJoint& between = joint_at(result, 0.004);
  REQUIRE(between.friction);
  CHECK_THAT(between.friction->at_rest, WithinRel(dry, kExact));
  CHECK_THAT(between.friction->efficiency_driving, WithinRel(40 / (40 + dry), kExact));
  // A quarter of the way: shares 3/4 and 1/4 of two independent sums of f_s and f_sm.
  const double sd = 0.05 * std::hypot(0.75, 0.25);
  CHECK_THAT(between.friction->sd, WithinRel(sd, kExact));
  CHECK_THAT(between.friction->high, WithinRel(dry + 1.959964 * sd, 1e-6));
  REQUIRE(between.sd);
  CHECK_THAT(between.sd->efficiency_driving, WithinRel(40 / std::pow(40 + dry, 2) * sd, kExact));
  // A fifth of 8 mrad beyond either end, and no further.
  CHECK(joint_at(result, 0.0115).friction);
  CHECK_FALSE(joint_at(result, 0.012).friction);
  CHECK_FALSE(joint_at(result, 0.0003).friction);
  REQUIRE(result.fitted.size() == 2);
  CHECK(result.fitted[1].preload == "high");
  CHECK_THAT(result.fitted[1].joints[0].friction->at_rest, WithinRel(5 + 0.25 * 28, kExact));
}

TEST_CASE("one fitted preload knows its own friction only", "[design]") {
  const DesignResult result = sweep({tension_fit("low", 0.002)}, {0.002, 0.003});
  CHECK(joint_at(result, 0.002).friction);
  CHECK_FALSE(joint_at(result, 0.003).friction);
  CHECK(result.fitted.empty());
  DesignOptions options;  // but a user may say how it grows
  options.torque = 40;
  options.l_o = {0.003};
  options.tension_friction = 0.1;
  const DesignResult given = sweep_design(tension_fit("low", 0.002), options);
  CHECK_THAT(joint_at(given, 0.003).friction->at_rest,
             WithinRel(5 + 0.25 * 5.6 + 0.1 * 8.4, kExact));
}

TEST_CASE("preloads that are alike make no line", "[design]") {
  const DesignResult result =
      sweep({tension_fit("a", 0.002), fit_at("b", 0.002, 9, 9)}, {0.002, 0.003});
  CHECK_FALSE(find_curve(result.friction, 0, kDryFriction)->line);
  CHECK_FALSE(joint_at(result, 0.002).friction);
}

// Cables that stiffen: l_o and tension are not proportional. Friction that is straight in l_o is
// refused over the tension.
TEST_CASE("friction that does not follow the tension goes along l_o", "[design]") {
  std::vector<Model> fitted;
  for (const double l_o : {0.0, 0.004, 0.008, 0.016}) {
    Model one = fit_at("p", 0, 3 + 400 * l_o, 2);
    for (Cable& cable : one.transmission.cables) {
      cable.order = 2;
      cable.coefficients = {100, 200000};
    }
    one.transmission = with_preload(one.transmission, l_o);
    fitted.push_back(one);
  }
  const std::vector<FrictionCurve> curves = friction_curves(fitted);
  const FrictionCurve* f_s = find_curve(curves, 0, "f_s");
  REQUIRE(f_s != nullptr);
  CHECK_FALSE(f_s->by_tension);
  CHECK_THAT(f_s->line->slope, WithinRel(400.0, kExact));
  CHECK(f_s->line->misfit == 0);
}

TEST_CASE("fits of another rig are refused", "[design]") {
  Model other = tension_fit("high", 0.01);
  other.transmission = antagonist_pairs(2, 1);
  CHECK(message_of([&] {
          (void)sweep({tension_fit("low", 0.002), other}, {0.002});
        }) ==
        "the fit of preload 'high' has 2 joints, the model has 1; give --fitted a result of the "
        "model's rig");
}

/// Friction of the hidden rig: grows with the sum of the tensions.
truth::Rig tension_rig(double l_o) {
  truth::Rig rig = stretched(l_o);
  const double tension =
      rig.cable_1.torque(l_o) + rig.cable_2.torque(rig.cable_2.initial_elongation);
  rig.f_s = 2.5 + 0.2 * tension;
  rig.f_sm = 2 + 0.06 * tension;
  return rig;
}

/// One blocked and two moving logs at each preload, in one step.
std::vector<Model> identified(const std::vector<double>& preloads, std::uint64_t& seed) {
  PreloadedBench bench;
  for (std::size_t k = 0; k < preloads.size(); ++k) {
    const std::string name = fmt::format("p{}", k);
    const truth::Rig rig = tension_rig(preloads[k]);
    bench.add(name, blocked_log(rig, seed++));
    for (const double load : {30.0, -40.0}) bench.add(name, moving_log(rig, seed++, load));
  }
  std::vector<Model> models;
  for (const IdentifyPreload& preload : identify(bench.logs(), {}).preloads)
    models.push_back(preload.model.value());
  return models;
}

// Whole path: simulated logs of three preloads, one step, curves; the truth at three preloads that
// were not recorded. Eight rigs (80 with CABLEFIT_MONTE_CARLO=full), nine bands each, of which
// about four are independent: 99.9 % of binomials of 32 (320) with 95 % lie above 81 % (91 %).
TEST_CASE("bands of friction hold the truth of rigs with tension friction",
          "[design][recover][monte-carlo]") {
  const int n_rigs = full_monte_carlo() ? 80 : 8;
  std::uint64_t seed = 5000;
  int n = 0, inside = 0, by_tension = 0;
  for (int run = 0; run < n_rigs; ++run) {
    const std::vector<FrictionCurve> curves = friction_curves(identified({1e-3, 4e-3, 8e-3}, seed));
    for (const double l_o : {2e-3, 6e-3, 9e-3}) {
      const truth::Rig rig = tension_rig(l_o);
      const double tension = 2 * rig.cable_1.torque(l_o);
      for (const auto& [name, value] :
           {std::pair<const char*, double>{"f_s", rig.f_s}, {"f_sm", rig.f_sm}, {"f_v", rig.f_v}}) {
        const FrictionCurve* curve = find_curve(curves, 0, name);
        REQUIRE(curve != nullptr);
        const auto found = curve->at(l_o, tension);
        REQUIRE(found);
        ++n;
        inside += found->low <= value && value <= found->high;
        by_tension += curve->by_tension;
      }
    }
  }
  std::printf("    %d of %d bands hold the truth (%.1f %%); %d by tension\n", inside, n,
              100.0 * inside / n, by_tension);
  CHECK(inside > (full_monte_carlo() ? 0.91 : 0.81) * n);
}

}  // namespace
