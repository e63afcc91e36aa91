// Table 1 of Fichera & Grossard 2017: logs made from each of its rows. One of them is a cable that
// pushes (paper/notes.md, 7).
#include <nlohmann/json.hpp>

#include "cablefit/elastic/models/passivity.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/elastic/curves.hpp"
#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

// rad. Of a sweep this wide the low-pass and the reversals leave rows on +-13.8 mrad, the range on
// which a straight line through the low row has the printed K.
constexpr double kReach = 0.01387;

/// A cable pair by coefficients, (30); a spring when both are the same straight line.
struct Row {
  double k10, k11, k20, k21, k12 = 0;

  double torque(double phi) const {
    return phi > 0 ? phi * (k10 + phi * (k11 + phi * k12)) : phi * (k20 - phi * k21);
  }
};

const Row kLowLinear{1819.2, 0, 1819.2, 0};
const Row kHighLinear{3605.2, 0, 3605.2, 0};
const Row kLowPoly{1367.7, 37844.1, 1575.3, 29357.2};
const Row kHighPoly{-3894.7, 3891.4, 11171.0, 3094.9};

/// Four sweeps of 50 s at even speed, so that every deflection weighs the same, in a motor with
/// 0.5 N m of friction; slow, so that the low-pass neither rounds the kink at zero nor takes much
/// of the ends.
std::string sweep(const Row& row, double noise = 0) {
  Normal normal(4600);
  Columns log;
  constexpr int kRows = 20000;
  std::vector<double> t, q(kRows, 0.0), theta, tau;
  for (int i = 0; i < kRows; ++i) {
    const double x = 4.0 * i / kRows + 0.5;
    const double part = x - std::floor(x);
    const bool up = static_cast<int>(x) % 2 == 0;
    t.push_back(0.01 * i);
    theta.push_back(kReach * (2 * part - 1) * (up ? 1 : -1));
    tau.push_back(row.torque(theta.back()) + (up ? 0.5 : -0.5) + noise * normal());
  }
  log.columns = {{"t", t}, {"q", q}, {"theta", theta}, {"tau", tau}};
  return log.csv();
}

ElasticResult result_of(const Row& row, const ElasticOptions& options, double noise = 0) {
  Bench bench;
  bench.add_text(sweep(row, noise));
  return fit_elastic(bench.logs(), options);
}

ElasticFit poly_of(const ElasticResult& result) { return *result.preloads.at(0).find("poly"); }

double value_of(const ElasticFit& fit, const char* name) {
  return estimate(fit.parameters, name).value;
}

ElasticOptions second_order(bool unconstrained) {
  ElasticOptions options;
  options.order = 2;
  options.unconstrained = unconstrained;
  return options;
}

/// Each to 0.1 %.
void check_row(const ElasticFit& fit, const Row& row) {
  const NamedValues truth = {
      {"K1_0", row.k10}, {"K1_1", row.k11}, {"K2_0", row.k20}, {"K2_1", row.k21}};
  for (const auto& [name, value] : truth) {
    const double found = value_of(fit, name.c_str());
    std::printf("    %s %.2f, true %.2f, off by %+.4f %%\n", name.c_str(), found, value,
                100 * (found - value) / std::abs(value));
    CHECK_THAT(found, Catch::WithinRel(value, 1e-3));
  }
}

TEST_CASE("the linear rows of Table 1 come back, cables and spring", "[elastic]") {
  for (const Row& row : {kLowLinear, kHighLinear}) {
    const ElasticResult result = result_of(row, {});
    const ElasticPreload& found = result.preloads.at(0);
    CHECK(found.selected == "linear");
    CHECK_THAT(value_of(*found.find("linear"), "K"), Catch::WithinRel(row.k10, 1e-3));
    const ElasticFit poly = poly_of(result);
    CHECK(poly.passive);
    CHECK(poly.active_bounds.empty());
    CHECK(poly.order == 1);
    CHECK_THAT(value_of(poly, "K1_0"), Catch::WithinRel(row.k10, 1e-3));
    CHECK_THAT(value_of(poly, "K2_0"), Catch::WithinRel(row.k10, 1e-3));
  }
}

TEST_CASE("the low polynomial row of Table 1 comes back, constrained or not", "[elastic]") {
  const ElasticFit poly = poly_of(result_of(kLowPoly, {}));
  CHECK(poly.order == 2);
  CHECK(poly.passive);
  check_row(poly, kLowPoly);
  ElasticOptions plain;
  plain.unconstrained = true;
  const ElasticFit same = poly_of(result_of(kLowPoly, plain));
  // Cables that pull by themselves: no bit differs.
  CHECK(same.covariance == poly.covariance);
  for (std::size_t k = 0; k < poly.parameters.size(); ++k)
    CHECK(same.parameters[k].value == poly.parameters[k].value);
  CHECK(same.held_out_max == poly.held_out_max);
}

// paper/notes.md, 8: the printed 1819.2 is what a straight line makes of the polynomial row on
// +-13.8 mrad, 1819.4; on +-50 mrad it is 2732.
TEST_CASE("the straight line of the low row has the printed K, and says on which range",
          "[elastic]") {
  const ElasticResult result = result_of(kLowPoly, {});
  const double k = value_of(*result.preloads.at(0).find("linear"), "K");
  std::printf("    K %.2f on %.2f .. %.2f mrad\n", k, 1e3 * result.preloads.at(0).deflection_low,
              1e3 * result.preloads.at(0).deflection_high);
  CHECK_THAT(k, Catch::WithinAbs(1819, 1));
  const std::string text = write_text(elastic_document(result));
  INFO(text);
  CHECK(text.find("preload          K     deflection ") != std::string::npos);
  CHECK(text.find("\ndefault       1819  -13.8 .. 13.8 ") != std::string::npos);
}

TEST_CASE("the high polynomial row of Table 1 is refused, with the reason", "[elastic]") {
  const ElasticResult result = result_of(kHighPoly, second_order(false));
  const ElasticFit poly = poly_of(result);
  print_all("warning", poly.warnings);
  CHECK(poly.passive);
  // All of a cable that would have to push is what it can do least: nothing.
  for (const char* name : {"K1_0", "K1_1"}) {
    const Estimate& e = estimate(poly.parameters, name);
    CHECK(e.value == 0);
    CHECK(std::isnan(e.sd));
    CHECK(e.profiled);  // under the constraints, so that it has an interval all the same
    CHECK(e.ci_low <= 1e-4 * e.ci_high);
    CHECK(e.ci_high > 0);
    CHECK(e.active_bound == "cable 1 only pulls");
  }
  // k(0) >= 0 is its own bound; profiles know bounds to 1e-5 of the sd of residuals of 1 N m.
  CHECK(estimate(poly.parameters, "K1_0").ci_low > -1e-3);
  CHECK(poly.active_bounds == std::vector<std::string>{"cable 1: k(l) >= 0 at l = 0 mrad",
                                                       "cable 1: k(l) >= 0 at l = 13.8 mrad"});
  CHECK(warns(poly.warnings,
              "not used: K1_0 = -3894.7 N m/rad, K1_1 = 3891.6 N m/rad^2, as cable 1 has a "
              "negative stiffness over elongations of 0 .. 13.8 mrad: k(l) = f(l)/l goes "
              "down to -3895 N m/rad at 0 mrad; a cable only pulls, (5) and (16) of the "
              "paper, so k(l) >= 0 is imposed: rms error "));
  CHECK(
      warns(poly.warnings,
            " instead of 0.00108 N m, sd given the active bounds; --unconstrained gives the plain "
            "fit"));
  CHECK_FALSE(warns(poly.warnings, "with which cable 2"));
  // Torque is negative on both sides of the kink; that is no arbitrary encoder zero.
  CHECK(find_estimate(poly.parameters, "theta_0") == nullptr);
  const std::string text = write_markdown(elastic_document(result));
  INFO(text);
  CHECK(text.find("selected, at bounds") != std::string::npos);
  CHECK(text.find("[1] at its bound: cable 1 only pulls") != std::string::npos);
}

TEST_CASE("orders are compared as they may be reported", "[elastic]") {
  const ElasticPreload found = result_of(kHighPoly, {}).preloads.at(0);
  const ElasticFit& poly = *found.find("poly");
  print_all("selection", found.selection);
  CHECK(poly.passive);
  // Cables that may push would follow the curve to 0.002 N m, on held-out blocks as well.
  CHECK(poly.rms_error > 10);
  CHECK(poly.held_out_rms > 10);
  REQUIRE_FALSE(found.selection.empty());
  CHECK(found.selection[0].find("order 2 is the lowest that no order up to 6 beats on held-out "
                                "blocks (rms 15.") == 0);
}

TEST_CASE("the high polynomial row comes back unconstrained, with a warning", "[elastic]") {
  const ElasticResult result = result_of(kHighPoly, second_order(true));
  const ElasticFit poly = poly_of(result);
  CHECK_FALSE(poly.passive);
  CHECK(poly.active_bounds.empty());
  check_row(poly, kHighPoly);
  REQUIRE(poly.warnings.size() == 1);
  CHECK(poly.warnings[0] ==
        "cable 1 has a negative stiffness over elongations of 0 .. 13.8 mrad: k(l) = "
        "f(l)/l goes down to -3895 N m/rad at 0 mrad, not physical by (5) and (16) of "
        "the paper: do not use this fit; fit again without --unconstrained");
  const auto& decisions = result.preloads.at(0).decisions;
  CHECK(std::any_of(decisions.begin(), decisions.end(), [](const Decision& d) {
    return d.name == "stiffness" && d.value == "unconstrained";
  }));
  // The same with noise, within its own sd.
  check_recovered(poly_of(result_of(kHighPoly, second_order(true), 0.3)).parameters,
                  {{"K1_0", kHighPoly.k10}, {"K2_0", kHighPoly.k20}, {"K2_1", kHighPoly.k21}}, 3);
}

// k(l) = 2000 - 250000 l reaches 0 at 8 mrad.
TEST_CASE("a cable that would push when it is long is bounded there", "[elastic]") {
  const ElasticResult result = result_of({2000, -250000, 1800, 0}, second_order(false));
  const ElasticFit poly = poly_of(result);
  const double longest = result.preloads.at(0).deflection_high;
  CHECK(poly.active_bounds == std::vector<std::string>{"cable 1: k(l) >= 0 at l = 13.8 mrad"});
  const Estimate& k10 = estimate(poly.parameters, "K1_0");
  const Estimate& k11 = estimate(poly.parameters, "K1_1");
  CHECK_THAT(k10.value + k11.value * longest, Catch::WithinAbs(0, 1e-9));
  CHECK(k10.value > 0);
  // Tied to each other, they have the sd of one number.
  CHECK(k10.active_bound.empty());
  CHECK_THAT(k10.sd, Catch::WithinRel(k11.sd * longest, 1e-6));
  CHECK(warns(poly.warnings,
              "as cable 1 has a negative stiffness over elongations of 8 .. 13.8 mrad"));
}

// k(l) = 4000 (l/L - 7/16)^2 - 100 with L = 13.8 mrad dips below 0 from 3.86 to 8.22 mrad.
TEST_CASE("a cable that would push in the middle is bounded there, hardly above 0", "[elastic]") {
  const double length = 0.0138;
  ElasticOptions third;
  third.order = 3;
  const ElasticResult result =
      result_of({665.625, -3500 / length, 1800, 0, 4000 / length / length}, third);
  const ElasticFit poly = poly_of(result);
  print_all("warning", poly.warnings);
  print_all("bound", poly.active_bounds);
  CHECK(warns(poly.warnings,
              "as cable 1 has a negative stiffness over elongations of 3.86 .. 8.22 "
              "mrad"));
  REQUIRE_FALSE(poly.active_bounds.empty());
  const Cable& cable = poly.transmission.cables[0];
  double least = kUnbounded;
  for (int i = 1; i <= 1000; ++i) least = std::min(least, cable.secant(length * i / 1000));
  // The conditions are Bernstein coefficients on eighths of the range: for a parabola the least of
  // them lies below it by at most an eighth of its second difference, 4000 / 64 / 4 = 16.
  CHECK(least >= -1e-9);
  CHECK(least <= 16);
  CHECK_FALSE(find_push(cable, length));
}

// k(l) = 4000 (l/L - 7/16)^2 + 3 pulls everywhere, but on the eighth of the range about its least
// value its middle Bernstein coefficient is 3 - 4000 / 256 = -13.
TEST_CASE("a cable that pulls stands as it is, whatever its Bernstein coefficients", "[elastic]") {
  const double length = 0.0138;
  const Row row{768.625, -3500 / length, 1800, 0, 4000 / length / length};
  ElasticOptions third;
  third.order = 3;
  const ElasticFit poly = poly_of(result_of(row, third));
  CHECK(poly.active_bounds.empty());
  CHECK(poly.passive);
  third.unconstrained = true;
  const ElasticFit plain = poly_of(result_of(row, third));
  CHECK(plain.covariance == poly.covariance);
  CHECK(plain.parameters[0].value == poly.parameters[0].value);
}

// One side only: cable 2 is hardly ever taut, its coefficients are not fitted, and the folds of the
// held-out blocks, which do fit them to noise, must not be bent by what that noise pushes.
TEST_CASE("a cable that is not fitted binds nothing", "[elastic]") {
  std::string text = sweep(kLowPoly, 3), half = "t,q,theta,tau\n";
  for (std::size_t at = text.find('\n') + 1; at < text.size(); at = text.find('\n', at) + 1) {
    double t = 0, q = 0, theta = 0, tau = 0;
    REQUIRE(std::sscanf(text.c_str() + at, "%lf,%lf,%lf,%lf", &t, &q, &theta, &tau) == 4);
    theta = 0.5 * (theta + kReach) - 3e-4;
    const double friction = tau - kLowPoly.torque(2 * (theta + 3e-4) - kReach);
    half += fmt::format("{},0,{},{}\n", t, theta, kLowPoly.torque(theta) + friction);
  }
  ElasticOptions options;
  Bench bench;
  bench.add_text(half);
  const ElasticFit bound = poly_of(fit_elastic(bench.logs(), options));
  options.unconstrained = true;
  const ElasticFit plain = poly_of(fit_elastic(bench.logs(), options));
  CHECK_FALSE(estimate(bound.parameters, "K2_0").not_identifiable.empty());
  CHECK(bound.active_bounds.empty());
  CHECK(bound.parameters[0].value == plain.parameters[0].value);
  CHECK(bound.order == plain.order);
  CHECK(bound.held_out_rms == plain.held_out_rms);
}

TEST_CASE("where a cable pushes is found", "[elastic]") {
  Cable cable = antagonist_pair(2).cables[0];
  cable.coefficients = {2000, -250000};  // k = 0 at 8 mrad, -500 at 10 mrad
  const std::optional<Push> push = find_push(cable, 0.01);
  REQUIRE(push);
  CHECK_THAT(push->from, Catch::WithinRel(0.008, 1e-5));  // up to what counts as rounding
  CHECK(push->to == 0.01);
  CHECK_THAT(push->lowest, Catch::WithinRel(-500.0, 1e-12));
  CHECK(push->lowest_at == 0.01);
  CHECK_FALSE(find_push(cable, 0.008));
  CHECK_FALSE(find_push(cable, -0.001));  // never taut
  cable.coefficients = {-500, 100000};    // up to 5 mrad
  const std::optional<Push> near = find_push(cable, 0.01);
  REQUIRE(near);
  CHECK(near->from == 0);
  CHECK_THAT(near->to, Catch::WithinRel(0.005, 1e-5));
  CHECK(near->lowest_at == 0);
  CHECK(push_text(cable, *near, {true, Axes::rotary}) ==
        "cable 1 has a negative stiffness over elongations of 0 .. 5 mm: k(l) = f(l)/l "
        "goes down to -500 N/m at 0 mm");
}

TEST_CASE("what is at its bound survives the result file", "[elastic]") {
  const ElasticResult result = result_of(kHighPoly, second_order(false));
  const std::string text = elastic_json(result);
  const auto json = nlohmann::json::parse(text);
  const auto& fit = json["preloads"][0]["fits"][1];
  CHECK(fit["passive"] == true);
  CHECK(fit["active_bounds"].size() == 2);
  CHECK(fit["parameters"][0]["value"] == 0);
  CHECK(fit["parameters"][0]["sd"].is_null());
  CHECK(fit["parameters"][0]["ci95"].size() == 2);
  CHECK(fit["parameters"][0]["interval"] == "profile");
  CHECK(fit["parameters"][0]["active_bound"] == "cable 1 only pulls");
  const TempFolder folder;
  const ElasticFit read = poly_of(read_elastic_result(folder.write("elastic.json", text)));
  CHECK(read.active_bounds == poly_of(result).active_bounds);
  CHECK(read.parameters[0].active_bound == "cable 1 only pulls");
  CHECK(read.parameters[0].profiled);
  CHECK(read.transmission.cables[0].coefficients == std::vector<double>{0, 0});
}

}  // namespace
