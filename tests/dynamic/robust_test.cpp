// Outliers: spikes in the torque bias plain weighted least squares, the robust fit names the
// moments and is not moved; on clean logs it finds nothing. The recursive fit ends where the direct
// one does; the sweep is flat on a right model and says what moves on a wrong one.
#include <algorithm>
#include <cmath>

#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

const NamedValues kTruth = {{"J", 0.02}, {"f_v", 0.35}, {"f_s", 0.9}, {"offset", 0.12}};
const MultiSine kMotion = {{{0.31, 0.6, 0.4}, {1.1, 0.3, 1.9}, {2.7, 0.12, 5.1}, {5.3, 0.05, 3.3}}};
constexpr double kNoise = 0.1;

/// 20 s at 1 kHz; `spike` is added to the torque at some samples.
template <typename Spike>
std::string drive_log(Spike spike) {
  Columns log;
  log.columns = {{"t", {}}, {"theta", {}}, {"tau", {}}};
  Normal normal(3000);
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i, v = kMotion.at(t, 1);
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(kMotion.at(t));
    log.columns[2].second.push_back(0.02 * kMotion.at(t, 2) + 0.35 * v + 0.9 * sign(v) + 0.12 +
                                    kNoise * normal() + spike(i, v));
  }
  return log.csv();
}

const auto kClean = [](int, double) { return 0.0; };

DynamicFit fit(const std::string& csv, const std::string& estimator, bool sweep = false,
               std::optional<double> cutoff = {}) {
  Bench bench;
  bench.add_text(csv);
  DynamicOptions options;
  options.models = {"rigid"};
  options.estimator = estimator;
  options.sweep = sweep;
  options.samples.cutoff = cutoff;
  options.samples.torque_hold = TorqueHold::none;
  return fit_dynamic(bench.logs(), {}, options).preloads.at(0).fits.at(0);
}

double worst_distance(const DynamicFit& fit, double (*sd)(const Estimate&)) {
  double worst = 0;
  for (const auto& [name, value] : kTruth) {
    const Estimate& e = estimate(fit.parameters, name);
    worst = std::max(worst, std::abs(e.value - value) / sd(e));
  }
  return worst;
}

TEST_CASE("spikes in the torque bias wls and not robust", "[dynamic]") {
  // Every half second a burst of 10 samples of 20 N m, while the axis moves forward: 1 % of the
  // rows. They would pull f_s and the offset.
  const auto spikes = [](int i, double v) { return i % 500 < 10 && v > 0.5 ? 20.0 : 0.0; };
  const std::string csv = drive_log(spikes);
  const DynamicFit clean = fit(drive_log(kClean), "wls");
  const DynamicFit wls = fit(csv, "wls"), robust = fit(csv, "robust");
  for (const auto& [name, value] : kTruth)
    std::printf("  %-7s true %.4f: wls %.4f, robust %.4f +- %.4f\n", name.c_str(), value,
                estimate(wls.parameters, name).value, estimate(robust.parameters, name).value,
                estimate(robust.parameters, name).sd);
  const auto own_sd = [](const Estimate& e) { return e.sd; };
  CHECK(worst_distance(robust, own_sd) < 3.5);
  // Against what the noise alone would leave, wls is far off.
  double off = 0;
  for (const auto& [name, value] : kTruth)
    off = std::max(off, std::abs(estimate(wls.parameters, name).value - value) /
                            estimate(clean.parameters, name).sd);
  CHECK(off > 10);
  CHECK(robust.estimator == "robust");
  CHECK_FALSE(robust.suspects.empty());
  CHECK(wls.suspects.empty());
}

TEST_CASE("one wrong sample is found, with its time and size", "[dynamic]") {
  const auto one = [](int i, double) { return i == 12345 ? 5.0 : 0.0; };
  const DynamicFit robust = fit(drive_log(one), "robust");
  REQUIRE(robust.suspects.size() == 1);
  const SuspectSpan& span = robust.suspects.front();
  // The filter rings for two periods of its cut-off, 20 ms, around it.
  CHECK(span.from > 12.345 - 0.02);
  CHECK(span.to < 12.345 + 0.02);
  CHECK(span.from <= 12.345 + 0.002);
  CHECK(span.largest > 0.5);  // 5 N m times the 2 * 0.1 of the band that passes, about 1
  CHECK(span.equation == "rigid");
  CHECK(span.log == "log0.csv");
}

TEST_CASE("clean logs have no suspects, and robust costs little", "[dynamic]") {
  const std::string csv = drive_log(kClean);
  const DynamicFit wls = fit(csv, "wls"), robust = fit(csv, "robust");
  CHECK(robust.suspects.empty());
  for (const Estimate& e : wls.parameters) {
    const Estimate& r = estimate(robust.parameters, e.name);
    INFO(e.name);
    // sqrt(1/0.95 - 1) = 0.23 sd is how far the two lie apart on average.
    CHECK(std::abs(r.value - e.value) < 1.0 * e.sd);
    CHECK_THAT(r.sd, Catch::WithinRel(e.sd, 0.25));
  }
}

TEST_CASE("the recursive fit ends at the weighted one, with a band that shrinks", "[dynamic]") {
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  const ElasticResult elastic = fit_elastic(blocked, {});
  const std::vector<LogSurvey> logs = {shipped("low/moving_load30.csv"),
                                       shipped("low/moving_load-40.csv")};
  DynamicOptions options;
  options.estimator = "wls";
  const DynamicFit direct = fit_dynamic(logs, elastic, options).preloads.at(0).fits.at(0);
  options.estimator = "recursive";
  const DynamicFit fit = fit_dynamic(logs, elastic, options).preloads.at(0).fits.at(0);
  REQUIRE(fit.traces.size() == 1);
  const RecursiveTrace& trace = fit.traces.front();
  const TracePoint& end = trace.points.back();
  REQUIRE(trace.points.size() > 150);
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    INFO(trace.names[k]);
    const Estimate& e = estimate(direct.parameters, trace.names[k]);
    // QR of the same rows in another order: the scaled columns' condition is below 100.
    CHECK_THAT(end.value[k], Catch::WithinRel(e.value, 1e-9));
    // The trace has no systematic part.
    const double floor = direct.method_floor.at(trace.names[k]);
    CHECK_THAT(end.sd[k], Catch::WithinRel(std::sqrt(e.sd * e.sd - floor * floor), 1e-9));
    CHECK(trace.points[trace.points.size() / 2].sd[k] > end.sd[k]);
  }
  CHECK(end.record == "moving_load-40.csv");
  CHECK(trace.points.front().record == "moving_load30.csv");
}

TEST_CASE("the sweep is flat on a right model, and a wrong cut-off shows", "[dynamic]") {
  const DynamicFit right = fit(drive_log(kClean), "wls", true);
  REQUIRE(right.sweep.has_value());
  REQUIRE(right.sweep->verdicts.size() == 3);
  for (const SweepVerdict& verdict : right.sweep->verdicts) {
    INFO(verdict.setting << ": " << verdict.text);
    CHECK(verdict.is_flat);
    CHECK(verdict.text.starts_with("flat"));
  }
  CHECK(right.sweep->points.size() == 15);
}

/// An encoder with noise of 1 mrad: below a cut-off of 40 Hz its acceleration is no longer small
/// beside the motion's, and J shrinks, the more the higher the cut-off (errors in variables).
std::string noisy_log() {
  Columns log;
  log.columns = {{"t", {}}, {"theta", {}}, {"tau", {}}};
  Normal normal(1);
  for (int i = 0; i < 20000; ++i) {
    const double t = 1e-3 * i, v = kMotion.at(t, 1);
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(kMotion.at(t) + 1e-3 * normal());
    log.columns[2].second.push_back(0.02 * kMotion.at(t, 2) + 0.35 * v + 0.9 * sign(v) + 0.12 +
                                    0.03 * normal());
  }
  return log.csv();
}

TEST_CASE("the sweep shows a cut-off that decides the answer", "[dynamic]") {
  const DynamicFit wrong = fit(noisy_log(), "wls", true, 30.0);
  const SweepVerdict& verdict = wrong.sweep->verdicts.at(0);
  std::printf("  %s\n", verdict.text.c_str());
  CHECK(verdict.setting == "cut-off");
  CHECK_FALSE(verdict.is_flat);
  CHECK_THAT(verdict.text, Catch::Matchers::StartsWith("J moves by ") &&
                               Catch::Matchers::EndsWith(" between 15 and 60 Hz"));
  // Falling all the way: the changes, in sd, are in order of the cut-off.
  const std::vector<SweepPoint>& points = wrong.sweep->points;
  for (std::size_t k = 1; k < 5; ++k) CHECK(points[k].change[0] < points[k - 1].change[0]);
}

TEST_CASE("the sweep shows a rest speed that decides the answer", "[dynamic]") {
  // Friction that is twice as large below 0.15 rad/s (Stribeck): what Coulomb friction is taken to
  // be depends on how many of these rows take part.
  const auto stribeck = [](int, double v) { return std::abs(v) < 0.15 ? 0.9 * sign(v) : 0.0; };
  const DynamicFit wrong = fit(drive_log(stribeck), "wls", true);
  const SweepVerdict& verdict = wrong.sweep->verdicts.at(1);
  std::printf("  %s\n", verdict.text.c_str());
  CHECK(verdict.setting == "rest speed");
  CHECK_FALSE(verdict.is_flat);
  CHECK_THAT(verdict.text, Catch::Matchers::Contains("f_s moves by "));
}

TEST_CASE("the sd says which it is and why", "[dynamic]") {
  const DynamicFit white = fit(drive_log(kClean), "wls");
  CHECK_THAT(white.sd_reason.at("rigid"),
             Catch::Matchers::StartsWith("white: ") || Catch::Matchers::StartsWith("HAC: "));
  // Noise of 1 s correlation time in 20 s.
  Normal normal(9);
  double state = 0;
  const auto slow = [&](int, double) {
    state = std::exp(-1e-3) * state + std::sqrt(2e-3) * normal();
    return 0.3 * state;
  };
  const DynamicFit drifting = fit(drive_log(slow), "wls");
  std::printf("  %s\n", drifting.sd_reason.at("rigid").c_str());
  CHECK_THAT(drifting.sd_reason.at("rigid"), Catch::Matchers::StartsWith("block bootstrap of ") &&
                                                 Catch::Matchers::Contains("degrees of freedom"));
  CHECK(estimate(drifting.parameters, "offset").sd > 5 * estimate(white.parameters, "offset").sd);
}

}  // namespace
