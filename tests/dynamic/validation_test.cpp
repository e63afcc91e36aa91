// Judging a fit: on logs it has not seen by condition, its residuals by tests; and that each of
// these sees what it is there for, and nothing else.
#include "cablefit/dynamic/validation_result.hpp"

#include "tests/support/columns.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr double kInertia = 0.02, kViscous = 0.35, kCoulomb = 0.9, kOffset = 0.12;  // SI
constexpr double kNoise = 0.1;                                                      // N m

/// A rigid drive on one of several motions; `extra` is torque that the model does not know.
struct Drive {
  double phase = 0.4, scale = 1, coulomb = kCoulomb;
  std::uint64_t seed = 1;
  double seconds = 20;
  double (*extra)(double position, double speed) = nullptr;
  bool has_reference = false;

  std::string csv() const {
    const MultiSine motion{{{0.31, 0.6, phase},
                            {1.1, 0.3, 1.9 + phase},
                            {2.7, 0.12, 5.1 - phase},
                            {5.3, 0.05, 3.3 + 2 * phase}}};
    Columns log;
    log.columns = {{"t", {}}, {"theta", {}}, {"tau", {}}};
    if (has_reference) log.columns.push_back({"theta_ref", {}});
    Normal normal(seed);
    for (int i = 0; i < 1000 * seconds; ++i) {
      const double t = 1e-3 * i, x = scale * motion.at(t), v = scale * motion.at(t, 1);
      log.columns[0].second.push_back(t);
      log.columns[1].second.push_back(x);
      log.columns[2].second.push_back(kInertia * scale * motion.at(t, 2) + kViscous * v +
                                      coulomb * sign(v) + kOffset + kNoise * normal() +
                                      (extra != nullptr ? extra(x, v) : 0));
      if (has_reference) log.columns[3].second.push_back(x);
    }
    return log.csv();
  }
};

/// Fits the first drive, validates on the others.
DynamicPreload judged(const std::vector<Drive>& drives) {
  Bench bench;
  bench.rig.sensors["tau"].noise = kNoise;
  for (const Drive& drive : drives) bench.add_text(drive.csv());
  DynamicOptions options;
  options.models = {"rigid"};
  options.validation.assign(bench.logs().begin() + 1, bench.logs().end());
  return fit_dynamic(bench.logs().first(1), {}, options).preloads.at(0);
}

const ConditionError& condition(const JudgedEquation& e, const std::string& name,
                                const std::string& value = "") {
  for (const ConditionError& c : e.conditions)
    if (c.condition == name && (value.empty() || c.value == value)) return c;
  FAIL("no condition " << name << " " << value);
  return e.conditions.front();
}

const ResidualTest& residual(const JudgedEquation& e, const std::string& name) {
  for (const ResidualTest& test : e.tests)
    if (test.name == name) return test;
  FAIL("no test against " << name);
  return e.tests.front();
}

const JudgedEquation& seen(const DynamicPreload& preload) {
  REQUIRE(preload.validation.has_value());
  return preload.validation->equations.at(0);
}

TEST_CASE("a right model holds on another motion, down to the noise", "[dynamic]") {
  const DynamicPreload preload = judged({{}, {.phase = 2.2, .seed = 2}});
  const JudgedEquation& e = seen(preload);
  for (const ConditionError& c : e.conditions) {
    INFO(c.condition << " " << c.value << ": " << c.verdict);
    CHECK_FALSE(c.fails);
  }
  for (const ResidualTest& test : e.tests) {
    INFO(test.name << ": " << test.verdict);
    CHECK(test.finding != Finding::material);
  }
  const ConditionError& all = condition(e, "all");
  // White noise on tau is all there is: floor and error are rms values of some 4000 rows each, so
  // they agree to 1/sqrt(2000) = 2 %, twice that with 2 sd on either side.
  CHECK_THAT(all.rms, Catch::WithinRel(e.noise_floor, 0.05));
  CHECK(e.floor_source == "sensor noise");
  CHECK(all.zero > 5 * all.rms);
  CHECK(all.linear > 3 * all.rms);  // dry friction is most of what it misses
  CHECK(preload.validation->linear_name == "without dry friction");
}

TEST_CASE("what changed on unseen logs is told, with its size", "[dynamic]") {
  // 0.3 N m more dry friction: rms sqrt(0.3^2 + (filtered noise 0.06)^2) = 0.31.
  const DynamicPreload preload = judged({{}, {.phase = 2.2, .coulomb = kCoulomb + 0.3, .seed = 2}});
  const JudgedEquation& e = seen(preload);
  const ConditionError& all = condition(e, "all");
  CHECK(all.fails);
  CHECK_THAT(all.rms, Catch::WithinAbs(0.31, 0.02));
  CHECK_THAT(condition(e, "direction", "+").mean, Catch::WithinAbs(0.3, 0.02));
  CHECK_THAT(condition(e, "direction", "-").mean, Catch::WithinAbs(-0.3, 0.02));
  CHECK(residual(e, "direction").finding == Finding::material);
  CHECK_THAT(residual(e, "direction").structure, Catch::WithinAbs(0.3, 0.02));
}

TEST_CASE("only the log that is different fails", "[dynamic]") {
  const DynamicPreload preload =
      judged({{}, {.phase = 2.2, .seed = 2}, {.phase = 1.1, .coulomb = 1.3, .seed = 3}});
  const JudgedEquation& e = seen(preload);
  CHECK_FALSE(condition(e, "log", "log1.csv").fails);
  CHECK(condition(e, "log", "log2.csv").fails);
}

TEST_CASE("speeds beyond those fitted stand apart", "[dynamic]") {
  const auto drag = [](double, double v) { return std::abs(v) > 3.5 ? 0.5 * sign(v) : 0.0; };
  const DynamicPreload preload =
      judged({{}, {.phase = 2.2, .scale = 1.6, .seed = 2, .extra = drag}});
  bool found = false;
  for (const ConditionError& c : seen(preload).conditions) {
    if (c.value.rfind("beyond the fitted", 0) != 0) continue;
    found = true;
    CHECK(c.fails);
  }
  CHECK(found);
  CHECK_FALSE(condition(seen(preload), "speed").fails);  // the slowest
}

TEST_CASE("residuals tell on what the model should have depended", "[dynamic]") {
  const auto cogging = [](double x, double) { return 0.2 * std::sin(20 * x); };
  const DynamicPreload with = judged({{.extra = cogging}}), without = judged({{}});
  const JudgedEquation& missed = with.residual_tests.at(0);
  const JudgedEquation& clean = without.residual_tests.at(0);
  // 8 bins over a range of about 2 rad cannot follow sin(20 x), period 0.3 rad: but its mean over a
  // bin is left.
  CHECK(residual(missed, "whiteness").finding == Finding::material);
  CHECK(residual(clean, "whiteness").finding == Finding::nothing);
  CHECK(residual(clean, "position theta").finding == Finding::nothing);
  CHECK(residual(clean, "velocity").finding != Finding::material);
  const auto spring = [](double x, double) { return 0.3 * x; };
  const DynamicPreload springy = judged({{.extra = spring}});
  const ResidualTest& seen_spring = residual(springy.residual_tests.at(0), "position theta");
  CHECK(seen_spring.finding == Finding::material);
  CHECK(seen_spring.structure > 0.05);
}

TEST_CASE("a dependence that is certain but small is said to be small", "[dynamic]") {
  // 0.01 N m rms against 1.2 N m of torque: seen in 100,000 rows, but below 1 %.
  const auto weak = [](double x, double) { return 0.02 * std::sin(3 * x); };
  const DynamicPreload preload = judged({{.seconds = 100, .extra = weak}});
  CHECK(residual(preload.residual_tests.at(0), "position theta").finding == Finding::immaterial);
}

TEST_CASE("repeats of one reference give the floor of all noise", "[dynamic]") {
  // The same motion three times, the last two unseen: what differs is the noise of tau; what both
  // have in common, here a cogging the model lacks, is no noise.
  const auto cogging = [](double x, double) { return 0.4 * std::sin(6 * x); };
  const Drive first{.phase = 1.0, .seed = 5, .extra = cogging, .has_reference = true};
  Drive second = first, third = first;
  second.seed = 6;
  third.seed = 7;
  const DynamicPreload preload = judged({first, second, third});
  const JudgedEquation& e = seen(preload);
  CHECK(e.floor_source == "repeats");
  CHECK(e.noise_floor > 0.03);
  CHECK(e.noise_floor < 0.08);  // 0.1 through the filter
  CHECK(condition(e, "all").rms > 3 * e.noise_floor);
  Drive other = second;
  other.phase = 0.2;
  CHECK(seen(judged({first, second, other})).floor_source == "sensor noise");
}

TEST_CASE("what cannot be judged is refused by name", "[dynamic]") {
  Bench bench;
  bench.add_text(Drive{}.csv());
  const LogSurvey& log = bench.logs()[0];
  const auto refusal = [&](LogSurvey unseen) {
    DynamicOptions options;
    options.models = {"rigid"};
    options.validation = {std::move(unseen)};
    return message_of([&] { fit_dynamic(bench.logs().first(1), {}, options); });
  };
  LogSurvey other = log;
  other.parts.at(0).preload = "high";
  CHECK(refusal(other) ==
        log.plan.path +
            ": no moving rows of a fitted preload (default); use the same preload names, "
            "or fit a log of this preload");
  Bench slow;
  std::string text = "t,theta,tau\n";
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("{:.3f},{:.6f},{:.6f}\n", 0.02 * i, std::sin(0.06 * i), std::cos(0.05 * i));
  slow.add_text(text);
  CHECK_THAT(refusal(slow.logs()[0]),
             Catch::Matchers::Contains("its rate of 50 Hz is too low for the fit's cut-off of"));
}

}  // namespace
