// Stage 1 on logs of the truth simulator at both preloads.
#include "tests/elastic/curves.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr const char* kClosure = "the stiffness falls on both sides of zero";

ElasticPreload shipped_fit(const std::string& preload, int order = 0) {
  const std::vector<LogSurvey> logs = {shipped(preload + "/blocked.csv")};
  ElasticOptions options;
  options.order = order;
  return fit_elastic(logs, options).preloads.at(0);
}

// The truth at high preload has both cables taut around zero and l_o, which stage 1 does not know:
// polynomials from zero must follow a curve with kinks at -4.7 and 5.1 mrad.
TEST_CASE("the curve of the shipped high log is followed to 1 % of its peak", "[elastic]") {
  const truth::Rig rig = truth::Rig::high();
  const ElasticPreload chosen = shipped_fit("high");
  const ElasticFit& poly = *chosen.find("poly");
  const double peak =
      std::max(rig.tau_elas(chosen.deflection_high), -rig.tau_elas(chosen.deflection_low));
  const double off = largest_curve_error(poly, rig, chosen.deflection_low, chosen.deflection_high);
  const ElasticPreload second = shipped_fit("high", 2);
  const double off_2 =
      largest_curve_error(*second.find("poly"), rig, second.deflection_low, second.deflection_high);
  std::printf(
      "  high: order %d, curve off by %.3f N m at most, %.2f %% of %.1f N m;"
      " order 2: %.3f N m, %.2f %%\n",
      poly.order, off, 100 * off / peak, peak, off_2, 100 * off_2 / peak);
  CHECK(off < 0.01 * peak);
  CHECK(second.find("poly")->order == 2);
  CHECK(off_2 > off);
}

TEST_CASE("preload is suspected at high preload and not at low", "[elastic]") {
  CHECK(warns(shipped_fit("high").warnings, kClosure));
  CHECK_FALSE(warns(shipped_fit("low").warnings, kClosure));
}

// K of a line depends on the rows it is fitted to, so the truth is what least squares makes of the
// true curve on the very rows: the rows are streamed again with the true elastic torque in the
// place of tau and projected on the same columns.
TEST_CASE("the linear stiffness is the least-squares slope of the true curve", "[elastic]") {
  for (const char* preload : {"low", "high"}) {
    const truth::Rig rig = std::string(preload) == "low" ? truth::Rig::low() : truth::Rig::high();
    const std::vector<LogSurvey> logs = {shipped(std::string(preload) + "/blocked.csv")};
    const ElasticPreload fit = fit_elastic(logs, {}).preloads.at(0);
    const Estimate& k = estimate(fit.find("linear")->parameters, "K");
    const double same_rows = slope_on_rows(logs, rig);
    const double uniform = slope_on_grid(rig, fit.deflection_low, fit.deflection_high);
    std::printf(
        "  %s: K %.2f, slope of the true curve %.2f on the rows, %.2f on a uniform grid;"
        " range %.2f to %.2f mrad\n",
        preload, k.value, same_rows, uniform, 1e3 * fit.deflection_low, 1e3 * fit.deflection_high);
    INFO(preload);
    CHECK_THAT(k.value, Catch::WithinRel(same_rows, 0.01));
    // The sweep of +-45 mrad as it was driven.
    CHECK(fit.deflection_low < -0.042);
    CHECK(fit.deflection_low > -0.048);
    CHECK(fit.deflection_high > 0.042);
    CHECK(fit.deflection_high < 0.048);
  }
}

TEST_CASE("cables of order 1 and 3 recover", "[elastic]") {
  for (const int order : {1, 3}) {
    truth::Rig rig = truth::Rig::low();
    if (order == 1) {
      rig.cable_1.stiffness = {1800};
      rig.cable_2.stiffness = {2300};
    } else {
      rig.cable_1.stiffness = {1367.7, 20000, 9e5};
      rig.cable_2.stiffness = {1575.3, 15000, 7e5};
    }
    truth::BlockedOptions options;
    options.seed = 4000 + static_cast<std::uint64_t>(order);
    Bench bench;
    bench.add(truth::simulate_blocked(rig, options));
    const ElasticPreload fit = fit_elastic(bench.logs(), {}).preloads.at(0);
    const ElasticFit& poly = *fit.find("poly");
    std::printf("  order %d found as %d\n", order, poly.order);
    print_all("  selection", fit.selection);
    CHECK(poly.order == order);
    check_recovered(poly.parameters, elastic_truth(rig), 3);
  }
}

TEST_CASE("equal linear cables are selected as one linear spring", "[elastic]") {
  truth::Rig rig = truth::Rig::low();
  rig.cable_1.stiffness = rig.cable_2.stiffness = {2100};
  truth::BlockedOptions options;
  options.seed = 4010;
  Bench bench;
  bench.add(truth::simulate_blocked(rig, options));
  const ElasticPreload fit = fit_elastic(bench.logs(), {}).preloads.at(0);
  CHECK(fit.selected == "linear");
  check_recovered(fit.find("linear")->parameters,
                  {{"K", 2100}, {"f_sm", rig.f_sm}, {"offset", rig.offset}}, 3);
}

}  // namespace
