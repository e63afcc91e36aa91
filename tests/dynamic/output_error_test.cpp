// The row `output-error`: what it says when the logs do not let it, what it takes from stage 1,
// what it makes of a parameter on its bound.
#include "tests/support/columns.hpp"
#include "tests/support/drive_rig.hpp"
#include "tests/support/recorded_log.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

const MultiSine kMotion = {{{0.31, 0.6, 0.4}, {1.1, 0.3, 1.9}, {2.7, 0.12, 5.1}, {5.3, 0.05, 3.3}}};
const MultiSine kOneSine = {{{0.2, 0.7, 0.3}}};

/// 10 s of a rigid drive at 500 Hz, its torque written with noise.
std::string drive_log(const MultiSine& motion, double viscous, const char* motion_column) {
  Columns log;
  log.columns = {{"t", {}}, {motion_column, {}}, {"tau", {}}};
  Normal normal(4100);
  const int derivative = std::string(motion_column) == "w" ? 1 : 0;
  for (int i = 0; i < 5000; ++i) {
    const double t = 2e-3 * i, v = motion.at(t, 1);
    log.columns[0].second.push_back(t);
    log.columns[1].second.push_back(motion.at(t, derivative));
    log.columns[2].second.push_back(0.02 * motion.at(t, 2) + viscous * v + 0.9 * sign(v) + 0.12 +
                                    0.1 * normal());
  }
  return log.csv();
}

DynamicPreload fit_drive(const MultiSine& motion, double viscous, const char* column,
                         const std::string& estimator) {
  Bench bench;
  bench.add_text(drive_log(motion, viscous, column));
  DynamicOptions options;
  options.models = {"rigid"};
  options.estimator = estimator;
  options.samples.torque_hold = TorqueHold::none;
  return fit_dynamic(bench.logs(), {}, options).preloads.at(0);
}

std::string reason(const DynamicPreload& preload, const std::string& name) {
  for (const Decision& d : preload.decisions)
    if (d.name == name) return d.value + ": " + d.reason;
  return "none";
}

TEST_CASE("output error without positions stays with wls and says why", "[dynamic]") {
  const DynamicPreload preload = fit_drive(kMotion, 0.35, "w", "output-error");
  CHECK(preload.fits.at(0).estimator == "wls");
  const std::string why = reason(preload, "estimator");
  INFO(why);
  CHECK(why.rfind("wls: no output error: ", 0) == 0);
  CHECK(why.find("has no positions to compare with") != std::string::npos);
}

TEST_CASE("output error of a rigid drive agrees with the truth", "[dynamic]") {
  const DynamicPreload preload = fit_drive(kMotion, 0.35, "theta", "output-error");
  const DynamicFit& fit = preload.fits.at(0);
  CHECK(fit.estimator == "output-error");
  // Four normal deviates beyond 3.5 sd: 0.2 %.
  check_recovered(fit.parameters, {{"J", 0.02}, {"f_v", 0.35}, {"f_s", 0.9}, {"offset", 0.12}},
                  3.5);
  CHECK(reason(preload, "output error").find("torque noise rigid 0.1 N m") != std::string::npos);
}

// Acceleration is -omega^2 times position whatever the estimator makes of it.
TEST_CASE("output error refuses the inertia of one sine as wls does", "[dynamic]") {
  const DynamicFit fit = fit_drive(kOneSine, 0.35, "theta", "output-error").fits.at(0);
  const Estimate& inertia = estimate(fit.parameters, "J");
  INFO(inertia.not_identifiable);
  CHECK(inertia.not_identifiable.find("is not separable from stiffness") != std::string::npos);
  CHECK(std::isnan(inertia.value));
  CHECK(std::isnan(inertia.sd));
  CHECK(fit.verdicts.at("J") == "not identifiable");
}

// True viscous friction 2 sd below 0: the parameter stands on its bound, with the sd that the same
// motion and noise give where the bound is far away. The two sd have noise levels of their own, 1 %
// apart. The estimate f that it would have if it were free lies between -5 and 0 sd, its profile
// ends at f + hypot(f, t sd): between 0.39 and t = 2.0 sd.
TEST_CASE("output error gives an interval at an active bound", "[dynamic]") {
  const Estimate away =
      estimate(fit_drive(kMotion, 0.35, "theta", "output-error").fits.at(0).parameters, "f_v");
  const Estimate e =
      estimate(fit_drive(kMotion, -2e-3, "theta", "output-error").fits.at(0).parameters, "f_v");
  CHECK(e.active_bound == "f_v >= 0");
  CHECK(e.value == 0);
  CHECK(e.ci_low == 0);
  CHECK_THAT(e.sd_white, Catch::WithinRel(away.sd_white, 0.05));
  CHECK(e.profiled);
  CHECK(e.ci_high > 0.39 * e.sd);
  CHECK(e.ci_high < 1.9 * e.sd);  // f below -0.1 sd: 2 sd are surely more than the data say
}

struct ElasticCase {
  ElasticResult stage1;
  std::vector<LogSurvey> logs;
};

/// 8 s of the low rig, stage 1 of the shipped log with its covariance times `factor`.
ElasticCase low_case(double factor) {
  const std::vector<LogSurvey> blocked = {shipped("low/blocked.csv")};
  ElasticCase out{fit_elastic(blocked, {}), {}};
  out.stage1.preloads.at(0).name = "default";
  for (ElasticFit& fit : out.stage1.preloads.at(0).fits) fit.covariance *= factor;
  Rig rig = default_rig();
  rig.torque_hold = TorqueHold::zoh;
  std::uint64_t seed = 4200;
  for (const double load : {-30.0, 30.0}) {
    truth::MovingOptions options;
    options.duration = 8;
    options.load = load;
    options.seed = seed++;
    out.logs.push_back(survey_of(truth::simulate_moving(truth::Rig::low(), options), rig));
  }
  return out;
}

DynamicFit fit_low(const ElasticCase& c) {
  DynamicOptions options;
  options.estimator = "output-error";
  return fit_dynamic(c.logs, c.stage1, options).preloads.at(0).fits.at(0);
}

TEST_CASE("output error leaves alone what stage 1 knows exactly", "[dynamic]") {
  const ElasticCase c = low_case(0);
  const DynamicFit fit = fit_low(c);
  REQUIRE(fit.estimator == "output-error");
  const ElasticFit& before = *c.stage1.preloads.at(0).find("poly");
  for (std::size_t i = 0; i < before.transmission.cables.size(); ++i)
    CHECK(fit.elastic->transmission.cables[i].coefficients ==
          before.transmission.cables[i].coefficients);
}

/// A stage 1 ten times sharper than the moving logs rules, a vague one is overruled.
TEST_CASE("output error takes stage 1 with its covariance", "[dynamic]") {
  const ElasticCase sharp = low_case(1e-4), vague = low_case(1e6);
  const ElasticFit& before = *sharp.stage1.preloads.at(0).find("poly");
  const DynamicFit with_sharp = fit_low(sharp), with_vague = fit_low(vague);
  Eigen::Index k = 0;
  for (const auto& [name, value] : elastic_truth(truth::Rig::low())) {
    INFO(name);
    const Estimate& e = estimate(with_sharp.elastic->parameters, name);
    const Estimate& alone = estimate(with_vague.elastic->parameters, name);
    const double sd_before = std::sqrt(before.covariance(k, k));
    ++k;
    // Both sd are estimates of a long-run variance, each of its own rows: 5 %.
    CHECK(e.sd <= 1.05 * sd_before);
    CHECK(alone.sd > 3 * e.sd);
    CHECK(std::abs(e.value - estimate(before.parameters, name).value) < 3.5 * sd_before);
    CHECK(std::abs(alone.value - value) < 3.5 * alone.sd);
  }
  // What the report carries on as covariance is that of the values beside it.
  const double variance = with_sharp.elastic->covariance(0, 0);
  CHECK_THAT(std::sqrt(variance),
             Catch::WithinRel(estimate(with_sharp.elastic->parameters, "K1_0").sd, 1e-12));
}

/// Drives with encoders of 16 bits, 20 s each.
truth::DriveOptions drive_options() {
  truth::DriveOptions options;
  options.duration = 20;
  options.quantum_theta = 2 * 3.14159265358979 / 65536;
  return options;
}

/// 2 N m, white.
truth::DriveOptions disturbed() {
  truth::DriveOptions options = drive_options();
  options.disturbance_sd = 2;
  options.disturbance_time = 1e-9;
  return options;
}

/// Of J, mean over 8 seeds, as a share. `source`: what is said of the instruments.
double mean_error(const std::string& estimator, truth::DriveOptions options,
                  Rig (*rig_of)(const truth::DriveOptions&), const std::string& source) {
  const truth::Drive drive;
  double mean = 0;
  for (options.seed = 1; options.seed <= 8; ++options.seed) {
    const std::vector<LogSurvey> logs = {
        survey_of(truth::simulate_drive(drive, options), rig_of(options))};
    DynamicOptions fit;
    fit.models = {"rigid"};
    fit.estimator = estimator;
    const DynamicPreload found = fit_dynamic(logs, {}, fit).preloads.at(0);
    const std::string instruments = reason(found, "instruments");
    INFO(instruments);
    CHECK(instruments.find(source) != std::string::npos);
    mean += (estimate(found.fits.at(0).parameters, "J").value / drive.J - 1) / 8;
  }
  return mean;
}

const char* const kSurrogate =
    "no controller in the rig file: a surrogate controller follows theta smoothed at ";

// 2 N m of white disturbance on a drive in closed loop come back through the controller into the
// motion: without instruments output error finds J 0.5 % too small, 2.8 sd of a log of 20 s (0.19
// %). Over 8 logs the mean scatters by 0.067 %: three of that.
TEST_CASE("output error keeps a disturbance out that comes back through the controller",
          "[dynamic][monte-carlo]") {
  CHECK(std::abs(mean_error("output-error", disturbed(), drive_rig,
                            "noise-free loop of the rig's controller")) < 0.002);
  // The same without a controller in the rig file: it is found from the log.
  CHECK(std::abs(mean_error("output-error", disturbed(), silent_drive_rig,
                            "noise-free loop of a controller found from the log's reference")) <
        0.002);
}

// A torque sensor with 1 N m of noise that is correlated over 0.1 s, which moves nothing: without
// instruments of a surrogate controller J came out 0.34 % too small on these logs. Over 8 logs of
// 20 s the mean scatters by 0.09 %: nearly three of that.
TEST_CASE("output error does not mind coloured torque noise", "[dynamic][monte-carlo]") {
  truth::DriveOptions options = drive_options();
  options.open_loop = options.on_sensor = true;
  CHECK(std::abs(mean_error("output-error", options, drive_rig, kSurrogate)) < 0.0025);
}

// The disturbance without any loop: the torque is a command, and the disturbance moves the drive.
// Both estimators find J some 0.4 to 0.5 % too small unless the rig file says so.
TEST_CASE("a commanded torque makes instruments", "[dynamic][monte-carlo]") {
  truth::DriveOptions options = disturbed();
  options.open_loop = true;
  for (const char* estimator : {"iv", "output-error"}) {
    INFO(estimator);
    CHECK(std::abs(mean_error(estimator, options, drive_rig, "the log's torque replayed")) < 0.002);
    CHECK(mean_error(estimator, options, silent_drive_rig, kSurrogate) < -0.003);
  }
}

}  // namespace
