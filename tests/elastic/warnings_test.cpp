// Logs that stage 1 must not take at face value.
#include <regex>

#include "tests/elastic/curves.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

truth::Log blocked(const truth::Rig& rig, std::uint64_t seed, bool plateaus = false) {
  truth::BlockedOptions options;
  options.seed = seed;
  options.plateaus = plateaus;
  return truth::simulate_blocked(rig, options);
}

ElasticPreload fit(const truth::Log& log, const ElasticOptions& options = {}) {
  Bench bench;
  bench.add(log);
  return fit_elastic(bench.logs(), options).preloads.at(0);
}

/// Quasi-static sweep by hand: theta up (and down), torque of `curve` +- friction plus noise.
template <typename Curve>
truth::Log sweep_log(Curve curve, double friction, double noise, int n_sweeps, std::uint64_t seed) {
  truth::Log log;
  Normal normal(seed);
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) / n * n_sweeps;
    const double part = x - std::floor(x);
    const bool up = static_cast<int>(std::floor(x)) % 2 == 0;
    const double theta = (up ? -1 + 2 * part : 1 - 2 * part) * 0.05;
    log.t.push_back(0.005 * i);
    log.q.push_back(0);
    log.theta.push_back(theta);
    log.tau.push_back(curve(theta) + (up ? friction : -friction) + noise * normal());
  }
  return log;
}

TEST_CASE("a sweep in one direction does not give f_sm and says so", "[elastic]") {
  const truth::Rig rig = truth::Rig::low();
  const auto curve = [&](double phi) { return rig.tau_elas(phi); };
  const ElasticPreload one = fit(sweep_log(curve, 2.778, 0.3, 1, 4100));
  CHECK_FALSE(one.both_branches);
  CHECK(warns(one.warnings, "theta moves in one direction only"));
  for (const ElasticFit& f : one.fits) {
    const Estimate& e = estimate(f.parameters, "f_sm");
    CHECK(e.not_identifiable == "theta moves in one direction only");
    CHECK(std::isnan(e.value));
    CHECK(std::isnan(e.sd));
  }
  const ElasticPreload four = fit(sweep_log(curve, 2.778, 0.3, 4, 4101));
  CHECK(four.both_branches);
  CHECK_FALSE(warns(four.warnings, "theta moves in one direction only"));
  NamedValues truth = elastic_truth(rig);
  truth.emplace_back("f_sm", 2.778);
  std::printf("  sweeps by hand\n");
  check_recovered(four.find("poly")->parameters, truth, 3);
}

TEST_CASE("what follows from coefficients that are not determined is said to be left out",
          "[elastic]") {
  // Both cables stay taut: only the sum of their stiffnesses shows.
  Bench bench;
  bench.rig.cables_given = true;
  for (Cable& cable : bench.rig.transmission.cables) {
    cable.order = 1;
    cable.initial_elongation = 0.2;
  }
  bench.add(sweep_log([](double phi) { return 3000 * phi; }, 2.778, 0.3, 6, 4100));
  const ElasticPreload one = fit_elastic(bench.logs(), {}).preloads.at(0);
  const ElasticFit& poly = one.fits.back();
  CAPTURE(poly.warnings);
  CHECK_FALSE(poly.parameters.front().not_identifiable.empty());
  CHECK(poly.derived.empty());
  CHECK(warns(poly.warnings,
              "K_rest and slack points are not given: they follow from coefficients "
              "that these logs do not determine"));
  CHECK_FALSE(warns(poly.warnings, "strongly correlated"));
}

TEST_CASE("a log of plateaus still gives the stiffness", "[elastic]") {
  const truth::Rig rig = truth::Rig::low();
  const ElasticPreload found = fit(blocked(rig, 4110, true));
  const ElasticFit& poly = *found.find("poly");
  std::printf("  plateaus: order %d, selected %s\n", poly.order, found.selected.c_str());
  print_all("  warning", found.warnings);
  const double peak = rig.tau_elas(found.deflection_high);
  const double off = largest_curve_error(poly, rig, found.deflection_low, found.deflection_high);
  Bench bench;
  bench.add(blocked(rig, 4110, true));
  const double slope = slope_on_rows(bench.logs(), rig);
  const double k = estimate(found.find("linear")->parameters, "K").value;
  std::printf("  plateaus: K %.2f, true curve's slope on the rows %.2f; curve off by %.2f %%\n", k,
              slope, 100 * off / peak);
  CHECK_THAT(k, Catch::WithinRel(slope, 0.02));
  CHECK(off < 0.02 * peak);
}

TEST_CASE("an arbitrary encoder zero is found", "[elastic]") {
  const truth::Rig rig = truth::Rig::low();
  truth::Log log = blocked(rig, 4120);
  const double shift = 0.008;
  for (double& theta : log.theta) theta += shift;
  const ElasticPreload found = fit(log);
  // The drive's offset of 0.0286 N m looks like a zero of -offset / K, 0.02 mrad at 1470 N m/rad.
  // It is part of theta_0: only a kink would separate the two.
  NamedValues truth = elastic_truth(rig);
  std::printf("  encoder zero at 8 mrad\n");
  check_recovered(found.find("poly")->parameters, truth, 3);
  const Estimate& zero = estimate(found.find("poly")->parameters, "theta_0");
  std::printf("    theta_0 %.4f +- %.4f mrad\n", 1e3 * zero.value, 1e3 * zero.sd);
  CHECK(std::abs(zero.value - (shift - rig.offset / 1470)) < 3 * zero.sd);
  CHECK(find_estimate(found.find("poly")->parameters, "offset") == nullptr);
  CHECK(found.find("poly")->transmission.theta_0(0) == zero.value);
}

/// Homed anew before the second log: one zero for both looks like a loop.
TEST_CASE("logs with zeros of their own are told from a loop", "[elastic]") {
  const truth::Rig rig = truth::Rig::low();
  constexpr double kShift = 0.002;
  const std::string own_zeros = "the encoder zero differs between logs";
  for (const double shift : {0.0, kShift}) {
    Bench bench;
    bench.add(blocked(rig, 4130));
    truth::Log other = blocked(rig, 4131);
    for (double& theta : other.theta) theta += shift;
    bench.add(other);
    const ElasticPreload found = fit_elastic(bench.logs(), {}).preloads.at(0);
    INFO("shift " << shift);
    print_all("  warning", found.warnings);
    CHECK(warns(found.warnings, own_zeros) == (shift > 0));
    CHECK_FALSE(warns(found.warnings, "no static friction"));
    if (shift == 0) continue;
    const auto warning = std::find_if(
        found.warnings.begin(), found.warnings.end(),
        [&](const std::string& text) { return text.find(own_zeros) != std::string::npos; });
    REQUIRE(warning != found.warnings.end());
    // "(... 0.0123 mrad in a, 2.01 mrad in b)"
    std::smatch zeros;
    REQUIRE(std::regex_search(*warning, zeros,
                              std::regex(R"(\((-?[0-9.]+) mrad in .*, (-?[0-9.]+) mrad in )")));
    CHECK(std::stod(zeros[2]) - std::stod(zeros[1]) == Approx(1e3 * shift).epsilon(0.02));
  }
}

TEST_CASE("without a blocked log there is one clear message", "[elastic]") {
  truth::MovingOptions options;
  options.seed = 4140;
  options.duration = 2;
  Bench bench;
  bench.add(truth::simulate_moving(truth::Rig::low(), options));
  CHECK(message_of([&] { fit_elastic(bench.logs(), {}); }, bench.folder().path().string()) ==
        "log0.csv: no log has a blocked link (q moves in all of them); give a blocked log, a "
        "'phase' column, or --still to use the parts in which the link rests");
}

// --still: a log that moves with the phase "moving" for half of its time and rests for the other
// half, motor swept.
TEST_CASE("stage 1 finds the parts of a moving log in which the link rests", "[elastic]") {
  const truth::Rig rig = truth::Rig::low();
  const auto curve = [&](double phi) { return rig.tau_elas(phi); };
  truth::Log log = sweep_log(curve, 2.778, 0.3, 4, 4150);
  const std::size_t n = log.t.size();
  for (std::size_t i = 0; i < n; ++i) {  // then the link swings, and its inertia spoils the balance
    const double s = 0.005 * static_cast<double>(i);
    const double q = 0.5 * (1 - std::cos(6 * s));
    log.t.push_back(0.005 * static_cast<double>(n + i));
    log.q.push_back(q);
    log.theta.push_back(q + 0.03 * std::sin(2.1 * s));
    log.tau.push_back(40 * std::cos(6 * s));
  }
  Bench bench;
  bench.add(log);
  ElasticOptions options;
  options.still = true;
  const ElasticPreload found = fit_elastic(bench.logs(), options).preloads.at(0);
  const double off = largest_curve_error(*found.find("poly"), rig, -0.04, 0.04);
  std::printf("  --still: curve off by %.3f N m at most, %zu rows used, %zu not used\n", off,
              found.counts.rows_used, found.counts.rows_not_used);
  CHECK(off < 0.02 * rig.tau_elas(0.04));
}

}  // namespace
