// refine from logs alone, and with values that a robot cannot have.
#include "cablefit/refine/bases/own_base.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/random.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/rows/physical_values.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/session/stages.hpp"
#include "tests/refine/hidden_logs.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

double value_of(const Model& model, const std::string& name) {
  for (const auto* effects : {&model.joints.at(0).link, &model.joints.at(0).motor})
    for (const EffectInstance& instance : *effects)
      for (const Estimate& e : instance.parameters)
        if (e.name == name) return e.value;
  return std::numeric_limits<double>::quiet_NaN();
}

TEST_CASE("a base of its own has the cables of stage 1 and the effects of stage 2", "[refine]") {
  RefineLogs logs;
  logs.blocked = {shipped("low/blocked.csv")};
  logs.train = {shipped("low/moving_load30.csv")};
  const OwnBase base = own_base(logs, 1);
  REQUIRE(base.models.size() == 1);
  const Model& model = base.models.front();
  CHECK(model.preload == "low");
  CHECK_FALSE(model.rigid);
  REQUIRE(model.transmission.cables.size() == 2);
  CHECK(model.transmission.cables[0].coefficients.at(0) ==
        Approx(truth::Rig::low().cable_1.stiffness[0]).epsilon(0.01));
  CHECK(model.joints.at(0).link.size() == base_effects(Side::link).size());
  CHECK(model.joints.at(0).motor.size() == base_effects(Side::motor).size());
  CHECK(value_of(model, "J_link") == 0.3);  // the rig's "cad", until the rows determine it
}

struct Orders {
  std::vector<int> of_stage1, of_base;
};

Orders orders_of(const truth::Rig& rig, const truth::BlockedOptions& sweep) {
  const auto orders = [](const std::vector<Cable>& cables) {
    std::vector<int> out;
    for (const Cable& cable : cables) out.push_back(cable.order);
    return out;
  };
  Bench blocked, moving;
  blocked.add(truth::simulate_blocked(rig, sweep));
  truth::MovingOptions options;
  options.duration = 8;
  moving.add(truth::simulate_moving(rig, options));
  const ElasticResult stage1 = fit_elastic(blocked.logs(), {});
  RefineLogs logs;
  logs.blocked = {blocked.logs()[0]};
  logs.train = {moving.logs()[0]};
  return {orders(stage1.preloads.at(0).find("poly")->transmission.cables),
          orders(own_base(logs, 1).models.at(0).transmission.cables)};
}

/// The trap: a cable that stage 1 gives the first order makes a stiffness_order of what it lacks.
TEST_CASE("cables of the base have the second order whatever stage 1 chooses", "[refine]") {
  truth::Rig rig = truth::Rig::low();
  rig.cable_2.stiffness = {1575.3};
  const Orders unequal = orders_of(rig, {});
  CHECK(unequal.of_stage1 == std::vector<int>{2, 1});
  CHECK(unequal.of_base == std::vector<int>{2, 2});
  truth::BlockedOptions narrow;
  narrow.range = 0.0015;  // rad: so little shows no curvature
  const Orders low = orders_of(truth::Rig::low(), narrow);
  CHECK(low.of_stage1 == std::vector<int>{1, 1});
  CHECK(low.of_base == std::vector<int>{2, 2});
}

TEST_CASE("without q the base is a rigid drive", "[refine]") {
  const HiddenLogs hidden = hidden_logs({});
  RefineLogs logs;
  logs.train = hidden.logs.train;
  for (LogSurvey& log : logs.train)
    for (Slot& slot : log.plan.slots)
      if (slot.channel == Channel::q) slot.channel = Channel::theta_ref;
  const OwnBase base = own_base(logs, 1);
  REQUIRE(base.models.size() == 1);
  CHECK(base.models.front().rigid);
  CHECK(base.models.front().joints.at(0).link.empty());
}

/// As servo logs have it, whose only encoder is at the output.
TEST_CASE("where q is a copy of theta the base is a rigid drive", "[refine]") {
  RefineLogs logs;
  logs.train = hidden_logs({}).logs.train;
  for (LogSurvey& log : logs.train) {
    const auto slot_of = [&](Channel channel) {
      return std::find_if(log.plan.slots.begin(), log.plan.slots.end(),
                          [&](const Slot& slot) { return slot.channel == channel; }) -
             log.plan.slots.begin();
    };
    const auto q = static_cast<std::size_t>(slot_of(Channel::q)),
               theta = static_cast<std::size_t>(slot_of(Channel::theta));
    for (PartSurvey& part : log.parts) part.channels.at(q) = part.channels.at(theta);
  }
  const OwnBase base = own_base(logs, 1);
  CHECK(base.models.front().rigid);
  CHECK(base.decisions.at(0).reason == "q is a copy of theta");
}

/// One log, given as text, without a model.
RefineResult refined(const std::string& text, std::vector<LogSurvey> RefineLogs::*use) {
  Bench bench;
  bench.add_text(text);
  RefineLogs logs;
  logs.*use = {bench.logs()[0]};
  RefineOptions options;
  options.n_draws = 6;
  return missing_effects(logs, options);
}

/// A blocked sweep up and down on one side of zero; in the last third on the other, if asked for.
std::string one_sided_sweep(bool both_sides) {
  constexpr double kStiffness = 50, kOther = 80, kFriction = 0.2, kPeak = 0.1;  // N m/rad, N m, rad
  constexpr double kSamplePeriod = 0.01, kRamp = 5, kSeconds = 60;
  Random random(1, 5);
  std::string rows = "t,q,theta,tau\n";
  for (int i = 0; i * kSamplePeriod < kSeconds; ++i) {
    const double t = i * kSamplePeriod, ramp = std::fmod(t, 2 * kRamp) / kRamp;  // up, then down
    const double side = both_sides && t >= 2 * kSeconds / 3 ? -1 : 1;
    const double theta = side * kPeak * (ramp < 1 ? ramp : 2 - ramp);
    const double direction = side * (ramp < 1 ? 1 : -1);
    const double tau =
        (side > 0 ? kStiffness : kOther) * theta + kFriction * direction + 0.02 * random.normal();
    rows += fmt::format("{:.3f},0,{:.6f},{:.5f}\n", t, theta, tau);
  }
  return rows;
}

std::string cables_decision(const RefineResult& result) {
  for (const Decision& decision : result.decisions)
    if (decision.name == "cables") return decision.value;
  return "";
}

TEST_CASE("a cable that the training samples never load makes the base a straight spring",
          "[refine]") {
  const RefineResult result = refined(one_sided_sweep(true), &RefineLogs::blocked);
  CHECK(cables_decision(result) == "a straight spring");
  CHECK(result.models.at(0).transmission.cables.empty());
}

/// The other cable's law is that of the robot all the same; a straight spring leaves its
/// stiffening.
TEST_CASE("a cable that no log loads is left out of the base", "[refine]") {
  const RefineResult result = refined(one_sided_sweep(false), &RefineLogs::blocked);
  CHECK(cables_decision(result) == "no cable 2");
  REQUIRE(result.models.at(0).transmission.cables.size() == 1);
  CHECK(result.models.at(0).transmission.cables[0].name == "1");
  CHECK(result.verdict == Verdict::none);
  REQUIRE(!result.warnings.empty());
  CHECK(result.warnings.back() ==
        "the base has no cable 2: the training samples hardly load it; all samples in which it is "
        "taut are left out; load both cables in each third of the logs, or give a model");
  std::string choice;
  const Model again = parse_model(parse_json(model_json(result.models.at(0)), "refined.json"), "",
                                  "", choice, Completeness::as_it_is);
  REQUIRE(again.transmission.cables.size() == 1);
  REQUIRE(again.transmission.idle_cables.size() == 1);
  CHECK(again.transmission.idle_cables[0].name == "2");
  CHECK(again.transmission.cables[0].coefficients ==
        result.models.at(0).transmission.cables[0].coefficients);
}

/// Dry friction and an offset are one constant then.
TEST_CASE("logs of one direction are refined without an offset", "[refine]") {
  constexpr double kJ = 0.01, kViscous = 0.2, kDry = 0.5, kMean = 2, kSwing = 1, kRate = 3;
  Random random(1, 6);
  std::string rows = "t,theta,tau\n";
  for (int i = 0; i < 12000; ++i) {
    const double t = i * 0.002, phase = kRate * t;
    const double theta = kMean * t + kSwing / kRate * std::sin(phase);
    const double speed = kMean + kSwing * std::cos(phase);
    const double tau = -kJ * kSwing * kRate * std::sin(phase) + kViscous * speed + kDry;
    rows += fmt::format("{:.3f},{:.6f},{:.5f}\n", t, theta, tau + 0.01 * random.normal());
  }
  const RefineResult result = refined(rows, &RefineLogs::train);
  CHECK(result.verdict == Verdict::none);
  CHECK(warns(result.warnings,
              "the logs do not separate offset of the base model from its other parameters: it is "
              "held at 0; move in both directions, at several speeds"));
  CHECK(value_of(result.models.at(0), "f_s") == Approx(kDry).epsilon(0.02));
}

TEST_CASE("what a model lacks begins at the CAD value, a bound or any inertia", "[refine]") {
  Model model = hidden_logs({}).models.front();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (auto* effects : {&model.joints[0].link, &model.joints[0].motor})
    for (EffectInstance& instance : *effects)
      for (Estimate& e : instance.parameters)
        if (e.name == "J_motor" || e.name == "J_link" || e.name == "f_v") e.value = none;
  model.rig.cad = {{"J_link", 0.3}};
  std::vector<Model> models = {model};
  const std::vector<Decision> decisions = fill_start_values(models);
  CHECK(value_of(models[0], "J_link") == 0.3);
  CHECK(value_of(models[0], "J_motor") > 0);
  CHECK(value_of(models[0], "f_v") == 0);
  REQUIRE(decisions.size() == 1);
  CHECK(decisions[0].value == "J_link (CAD), f_v, J_motor");
  CHECK(fill_start_values(models).empty());
}

TEST_CASE("what is simulated has inertias and frictions that a robot can have", "[refine]") {
  const HiddenLogs hidden = hidden_logs({});
  const auto any = [](const PartSurvey& /*part*/) { return true; };
  std::vector<LogSurvey> logs = hidden.logs.blocked;
  logs.insert(logs.end(), hidden.logs.train.begin(), hidden.logs.train.end());
  std::vector<Stretch> stretches = read_stretches(logs, hidden.models, any);
  const Smoothing smoothing = smoothing_for(finest_period(stretches, false));
  const BaseFit base =
      fit_base(make_design(hidden.models, std::move(stretches), smoothing), 2, nullptr);
  const auto physical = [&](const Eigen::VectorXd& x, std::vector<Eigen::Index>* held = nullptr) {
    return physical_values(base.design, 2, base.levels, x, held);
  };
  CHECK(physical(base.fit.x) == base.fit.x);  // to the last bit

  Eigen::VectorXd beyond = base.fit.x;
  const auto column = [&](const std::string& name) {
    for (std::size_t k = 0; k < base.design.layout.parameters.size(); ++k)
      if (base.design.layout.parameters[k].name == name) return static_cast<Eigen::Index>(k);
    FAIL("no column " << name);
    return Eigen::Index{0};
  };
  beyond(column("J_motor")) = -0.01;
  std::vector<Eigen::Index> held;
  const Eigen::VectorXd x = physical(beyond, &held);
  CHECK(held == std::vector<Eigen::Index>{column("J_motor")});
  CHECK(x(column("J_motor")) > 0);
  // All others are the best beside these: no other value of one of them fits better.
  const double least = errors_of(base.grams, base.levels, x).sum();
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    if (k == column("J_motor")) continue;
    for (const double step : {-1e-3, 1e-3}) {
      Eigen::VectorXd other = x;
      other(k) *= 1 + step;
      CHECK(errors_of(base.grams, base.levels, other).sum() >= least * (1 - 1e-9));
    }
  }
}

}  // namespace
