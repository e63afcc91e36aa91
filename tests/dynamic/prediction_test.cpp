// What `check` says of moving logs before any fit, against the fit.
#include "cablefit/dynamic/prediction.hpp"

#include <functional>

#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kInertia = 0.02, kViscous = 0.35, kCoulomb = 0.9, kOffset = 0.12;  // SI
constexpr double kNoise = 0.05;

struct Motion1 {
  std::function<double(double)> position, velocity, acceleration;
};

Motion1 sines(const MultiSine& sum) {
  return {[sum](double t) { return sum.at(t); }, [sum](double t) { return sum.at(t, 1); },
          [sum](double t) { return sum.at(t, 2); }};
}

/// 20 s of a rigid drive at 1 kHz. `ripple`: N m, 40 periods a radian, which no effect explains.
Bench drive(const Motion1& motion, std::uint64_t seed, double coulomb = kCoulomb,
            double ripple = 0) {
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  Normal normal(seed);
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i, speed = motion.velocity(t);
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(motion.position(t));
    log.columns[2].second.push_back(kInertia * motion.acceleration(t) + kViscous * speed +
                                    coulomb * sign(speed) + kOffset +
                                    ripple * std::sin(40 * motion.position(t)) + kNoise * normal());
  }
  Bench bench;
  bench.add_text(log.csv());
  return bench;
}

std::vector<Prediction> predict(std::span<const LogSurvey> logs) {
  return predict_estimates(logs, check_logs(logs, {}), {});
}

PredictedEquation predict_rigid(const Bench& bench) {
  const std::vector<Prediction> all = predict(bench.logs());
  REQUIRE(all.size() == 1);
  INFO(all[0].none);
  REQUIRE(all[0].equations.size() == 1);
  CHECK(all[0].rigid);
  for (const std::string& sentence : all[0].equations[0].sentences)
    std::printf("    %s\n", sentence.c_str());
  return all[0].equations[0];
}

const PredictedParameter& parameter(const PredictedEquation& e, const std::string& name) {
  for (const PredictedParameter& p : e.parameters)
    if (p.name == name) return p;
  FAIL("no parameter " << name);
  return e.parameters.front();
}

const MultiSine kRich = {{{0.31, 0.6, 0.4}, {1.1, 0.3, 1.9}, {2.7, 0.12, 5.1}, {5.3, 0.05, 3.3}}};

TEST_CASE("rich motion of a rigid drive promises what the fit then achieves", "[dynamic]") {
  const Bench bench = drive(sines(kRich), 3300);
  const PredictedEquation e = predict_rigid(bench);
  CHECK(e.sentences.empty());
  DynamicOptions options;
  options.models = {"rigid"};
  const DynamicFit fit = fit_dynamic(bench.logs(), {}, options).preloads.at(0).fits.at(0);
  for (const Estimate& found : fit.parameters) {
    const PredictedParameter& p = parameter(e, found.name);
    std::printf("    %-6s at best %.3g, first look %.3g; achieved white %.3g, honest %.3g\n",
                p.name.c_str(), p.sd_best, p.sd_first_look, found.sd_white, found.sd);
    CHECK(p.determined == Determined::identifiable);
    // All noise is white, and bounded by what is left; its sd from sixth differences and its rms
    // over a few thousand rows are within 1 % each.
    CHECK(p.sd_best == Approx(found.sd_white).epsilon(0.05));
    const double floor = fit.method_floor.at(found.name);  // not predicted
    CHECK(p.sd_first_look == Approx(std::sqrt(found.sd * found.sd - floor * floor)).epsilon(0.05));
    CHECK(p.size == Approx(found.value).epsilon(0.1).margin(3 * found.sd));
  }
}

// Smooth torque, so that sixth differences of it show noise alone: what the sensors' noise makes in
// the rows is what a fit of the true model leaves, and stays so when the model is wrong.
constexpr double kFaint = 0.001;  // N m of dry friction, 0.1 % of the torque
TEST_CASE("noise of the sensors is told from what the model leaves", "[dynamic]") {
  const PredictedEquation right = predict_rigid(drive(sines(kRich), 3310, kFaint));
  const PredictedEquation wrong = predict_rigid(drive(sines(kRich), 3311, kFaint, 0.3));
  CHECK(wrong.left > 5 * right.left);
  // Its sd is more than half of it, but it is known not to count.
  CHECK(parameter(right, "f_s").sd_first_look > 0.5 * kFaint);
  CHECK(parameter(right, "f_s").determined == Determined::identifiable);
  CHECK(right.sentences.empty());
  CHECK(wrong.noise == Approx(right.left).epsilon(0.05));
  const PredictedParameter& p = parameter(wrong, "f_v");
  CHECK(p.sd_first_look > 3 * p.sd_best);
  CHECK(p.sd_best == Approx(parameter(right, "f_v").sd_best).epsilon(0.05));
}

TEST_CASE("one speed back and forth: viscous and dry friction are not promised", "[dynamic]") {
  const double speed = 0.5, half = 1;  // rad/s, s
  const Motion1 triangle = {
      [=](double t) {
        const double phase = std::fmod(t, 2 * half);
        return speed * (phase < half ? phase : 2 * half - phase);
      },
      [=](double t) { return std::fmod(t, 2 * half) < half ? speed : -speed; },
      [](double) { return 0.0; }};
  const PredictedEquation e = predict_rigid(drive(triangle, 3301));
  for (const char* name : {"f_v", "f_s"}) {
    CHECK(parameter(e, name).determined != Determined::identifiable);
    CHECK(parameter(e, name).correlation < -0.95);
  }
  CHECK(parameter(e, "f_v").closest == "f_s");
  CHECK(parameter(e, "offset").determined == Determined::identifiable);
  CHECK(warns(e.sentences, "f_v and f_s are"));
  CHECK(warns(e.sentences, "strongly correlated: -"));
  CHECK(
      warns(e.sentences, "move at several speeds, slow and fast (a speed ladder); now 0.5 rad/s"));
  CHECK(e.condition_scaled > 6);  // 2 sqrt of (1 + 0.95) / (1 - 0.95)
}

TEST_CASE("motion in one direction: dry friction and offset are not promised", "[dynamic]") {
  const MultiSine wave = {{{0.4, 0.1, 0.3}, {1.3, 0.04, 1.2}, {3.1, 0.01, 0.7}}};
  const Motion1 onward = {[=](double t) { return t + wave.at(t); },
                          [=](double t) { return 1 + wave.at(t, 1); },
                          [=](double t) { return wave.at(t, 2); }};
  const PredictedEquation e = predict_rigid(drive(onward, 3302));
  CHECK(parameter(e, "f_s").determined == Determined::not_identifiable);
  CHECK(parameter(e, "offset").determined == Determined::not_identifiable);
  CHECK(std::isinf(parameter(e, "f_s").sd_best));
  CHECK(parameter(e, "J").determined == Determined::identifiable);
  CHECK(parameter(e, "f_v").determined == Determined::identifiable);
  CHECK(warns(e.sentences,
              "f_s and offset are not separable: correlation -1.000, only offset + "
              "1 f_s shows; move in both directions"));
}

TEST_CASE("one sine: an inertia is not promised", "[dynamic]") {
  const PredictedEquation e = predict_rigid(drive(sines({{{0.2, 0.7, 0.3}}}), 3303));
  CHECK(parameter(e, "J").determined == Determined::not_identifiable);
  CHECK(parameter(e, "f_v").determined == Determined::identifiable);
  CHECK(warns(e.sentences, "J: the acceleration is "));
  CHECK(warns(e.sentences,
              "inertia is not separable from stiffness or gravity; move at several "
              "frequencies"));
}

TEST_CASE("slow motion: an inertia is not promised, and the acceleration it needs is",
          "[dynamic]") {
  const MultiSine slow = {{{0.05, 0.6, 0.4}, {0.11, 0.3, 1.9}, {0.17, 0.1, 5.1}}};
  const PredictedEquation e = predict_rigid(drive(sines(slow), 3304));
  CHECK(parameter(e, "J").determined != Determined::identifiable);
  CHECK(parameter(e, "f_s").determined == Determined::identifiable);
  CHECK(warns(e.sentences, "accelerate with "));
  // Three times as fast is nine times the acceleration.
  MultiSine fast = slow;
  for (MultiSine::Line& line : fast.lines) line.hz *= 6;
  CHECK(parameter(predict_rigid(drive(sines(fast), 3305)), "J").determined ==
        Determined::identifiable);
}

/// What is promised of the shipped logs without stage 1, beside what both stages achieve.
void compare(const std::string& preload) {
  const std::vector<LogSurvey> blocked = {shipped(preload + "/blocked.csv")};
  const std::vector<LogSurvey> moving = {shipped(preload + "/moving_load30.csv"),
                                         shipped(preload + "/moving_load-40.csv")};
  const DynamicFit fit =
      fit_dynamic(moving, fit_elastic(blocked, {}), {}).preloads.at(0).fits.at(0);
  const std::vector<Prediction> all = predict(moving);
  REQUIRE(all.size() == 1);
  INFO(all[0].none);
  REQUIRE(all[0].equations.size() == 2);
  CHECK(all[0].logs.size() == 2);
  for (const PredictedEquation& e : all[0].equations) {
    std::printf("  %s, %s: noise %.3g, rough model leaves %.3g, fit leaves %.3g\n", preload.c_str(),
                e.name.c_str(), e.noise, e.left, fit.torque_error.at(e.name).rms);
    for (const PredictedParameter& p : e.parameters) {
      const Estimate& found = estimate(fit.parameters, p.name);
      std::printf(
          "    %-8s roughly %8.3g (%8.3g); at best %.3g (white %.3g), first look %.3g (%.3g)\n",
          p.name.c_str(), p.size, found.value, p.sd_best, found.sd_white, p.sd_first_look,
          found.sd);
      CHECK(p.sd_best == Approx(found.sd_white).epsilon(0.25));
      CHECK(p.determined == Determined::identifiable);
      // The offset is what an error of stage 1 shifts, which no look at moving logs can know.
      if (p.name != "offset") CHECK(p.sd_first_look == Approx(found.sd).epsilon(0.25));
    }
  }
}

TEST_CASE("what is promised of the shipped logs of low preload is achieved", "[dynamic]") {
  compare("low");
}

TEST_CASE("a log that nothing can be fitted to gets a reason", "[dynamic]") {
  Columns log{{{"t", {}}, {"theta", {}}, {"tau", {}}}};
  for (int i = 0; i < 40; ++i) {
    log.columns[0].second.push_back(0.01 * i);
    log.columns[1].second.push_back(i < 38 ? 0.0 : 0.1);
    log.columns[2].second.push_back(i);
  }
  Bench bench;
  bench.add_text(log.csv());
  const std::vector<Prediction> all = predict(bench.logs());
  REQUIRE(all.size() == 1);
  CHECK(all[0].equations.empty());
  CHECK_FALSE(all[0].none.empty());
}

}  // namespace
