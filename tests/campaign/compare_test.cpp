// The rule that decides whether two estimates differ, and which estimates of two results are
// compared.
#include "cablefit/campaign/compare/compare.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>

#include "tests/support/columns.hpp"
#include "tests/support/message.hpp"
#include "tests/support/recorded_estimate.hpp"

namespace cablefit {
namespace {

using test::recorded_estimate;

RecordedResult result(const std::string& log, std::vector<Estimate> estimates,
                      const std::string& preload = "low") {
  RecordedResult r;
  r.path = log + ".json";
  r.command = "dynamic";
  r.inputs = {{log + ".csv", log, 10}};
  EstimateSet set{"stage 2", preload, "poly", "wls"};
  set.torque_scale = 10;
  set.estimates = std::move(estimates);
  r.sets = {set};
  return r;
}

ComparedParameter compared(double first, double second, double sd, std::size_t n_others = 0) {
  std::vector<Estimate> a{recorded_estimate("f_s", first, sd)},
      b{recorded_estimate("f_s", second, sd)};
  for (std::size_t k = 0; k < n_others; ++k) {
    a.push_back(recorded_estimate("x" + std::to_string(k), 1, 1));
    b.push_back(recorded_estimate("x" + std::to_string(k), 1, 1));
  }
  return compare(result("a", a), result("b", b), {}).parameters.front();
}

// Welch: two equal variances of 20 degrees of freedom each make 40; R: 2 * pt(-2, 40) =
// 0.0523223432.
TEST_CASE("a difference is judged by Welch's t test", "[compare]") {
  const ComparedParameter p = compared(10, 10 + 2 * std::sqrt(2.0), 1);
  CHECK(p.sd == Approx(std::sqrt(2.0)));
  CHECK(p.dof == Approx(40).epsilon(1e-5));
  CHECK(p.p_value == Approx(0.0523223432).epsilon(1e-5));
  CHECK(p.percent() == Approx(20 * std::sqrt(2.0)));
}

// 1 - (1 - p)^7; the same difference that one parameter alone would call different.
TEST_CASE("all parameters are judged together", "[compare]") {
  const double second = 10 + 2.3 * std::sqrt(2.0);
  CHECK(compared(10, second, 1).sameness == Sameness::different);
  const ComparedParameter together = compared(10, second, 1, 6);
  CHECK(together.sameness == Sameness::undecided);
  CHECK(together.p_together == Approx(1 - std::pow(1 - together.p_value, 7)));
  CHECK(together.low < 0);
}

TEST_CASE("equal is shown, not assumed", "[compare]") {
  CHECK(compared(10, 10.1, 0.1).sameness == Sameness::equal);
  const ComparedParameter few = compared(10, 10.1, 1);
  CHECK(few.sameness == Sameness::undecided);
  // (t sd / margin)^2 with t(90 %, 40) = 1.68385, sd^2 = 2, margin 0.5.
  CHECK(few.more_data == Approx(1.68385 * 1.68385 * 2 / 0.25).epsilon(1e-4));
}

TEST_CASE("a difference may be certain and of no importance", "[compare]") {
  const ComparedParameter p = compared(10, 10.2, 0.01);
  CHECK(p.sameness == Sameness::different);
  CHECK(p.is_within_margin);
}

TEST_CASE("an offset is measured by the torque, not by itself", "[compare]") {
  const CompareResult r = compare(result("a", {recorded_estimate("offset", 0.001, 0.01)}),
                                  result("b", {recorded_estimate("offset", -0.001, 0.01)}), {});
  CHECK(r.parameters.front().margin == Approx(0.5));
  CHECK(r.parameters.front().sameness == Sameness::equal);
  CHECK(std::isnan(r.parameters.front().percent()));
}

// Correlated or not: Sidak's bound holds, and independent estimates reach it.
TEST_CASE("5 % of pairs without a change are different somewhere", "[compare]") {
  constexpr int kPairs = 4000, kParameters = 7;
  test::Normal normal(77);
  int different = 0;
  for (int k = 0; k < kPairs; ++k) {
    std::vector<Estimate> a, b;
    for (int i = 0; i < kParameters; ++i) {
      // The sd that was estimated from 20 residuals.
      const auto sd = [&] {
        double sum = 0;
        for (int j = 0; j < 20; ++j) sum += std::pow(normal(), 2);
        return std::sqrt(sum / 20);
      };
      const std::string name = "x" + std::to_string(i);
      a.push_back(recorded_estimate(name, 100 + normal(), sd()));
      b.push_back(recorded_estimate(name, 100 + normal(), sd()));
    }
    different += compare(result("a", a), result("b", b), {}).count(Sameness::different) > 0;
  }
  const double share = static_cast<double>(different) / kPairs;
  std::printf("    different somewhere: %.2f %%\n", 100 * share);
  CHECK(std::abs(share - 0.05) < 3.29 * std::sqrt(0.05 * 0.95 / kPairs));
}

TEST_CASE("results of the same logs differ by method, not by chance", "[compare]") {
  const CompareResult r = compare(result("a", {recorded_estimate("f_s", 10, 1)}),
                                  result("a", {recorded_estimate("f_s", 11, 1)}), {});
  CHECK(r.parameters.front().sameness == Sameness::different);
  CHECK(r.warnings.size() == 1);
}

TEST_CASE("logs fitted in both results are named", "[compare]") {
  RecordedResult a = result("a", {recorded_estimate("f_s", 10, 1)}),
                 b = result("b", {recorded_estimate("f_s", 11, 1)});
  a.inputs.push_back({"both.csv", "both", 10});
  b.inputs = {{"copy/both.csv", "both", 10}};
  CHECK(compare(a, b, {}).warnings ==
        std::vector<std::string>{
            "both results were fitted to both.csv (1 of 2 logs of a.json, the only log of "
            "b.json): their errors are correlated; the test assumes independent errors and "
            "finds fewer differences"});
}

TEST_CASE("a stage 1 of both results is no log", "[compare]") {
  RecordedResult a = result("a", {recorded_estimate("f_s", 10, 1)}),
                 b = result("b", {recorded_estimate("f_s", 11, 1)});
  for (RecordedResult* r : {&a, &b}) r->inputs.push_back({"out/elastic.json", "stage 1", 0});
  CHECK(compare(a, b, {}).warnings ==
        std::vector<std::string>{
            "both results use out/elastic.json: their errors are correlated; the test "
            "assumes independent errors and finds fewer differences"});
}

TEST_CASE("two preloads of one result are not the same logs", "[compare]") {
  RecordedResult both = result("a", {recorded_estimate("f_s", 10, 1)});
  both.sets.push_back(both.sets.front());
  both.sets.back().preload = "high";
  both.sets.back().estimates = {recorded_estimate("f_s", 11, 1)};
  CompareOptions options;
  options.first_preload = "low";
  options.second_preload = "high";
  const CompareResult r = compare(both, both, options);
  CHECK(r.parameters.front().preload == "low / high");
  CHECK(r.parameters.front().sameness == Sameness::undecided);
  CHECK(r.warnings.empty());
}

TEST_CASE("what only one result has is told", "[compare]") {
  const CompareResult r = compare(
      result("a", {recorded_estimate("f_s", 10, 1), recorded_estimate("f_v", 1, 1)}),
      result("b", {recorded_estimate("f_s", 10, 1), recorded_estimate("J_link", 1, 1)}), {});
  REQUIRE(r.not_compared.size() == 2);
  CHECK(r.not_compared[0].reason == "only in the first result");
  CHECK(r.not_compared[1].name == "J_link");
}

TEST_CASE("coefficients of another order are another thing", "[compare]") {
  const auto elastic = [](const std::string& log, int order) {
    RecordedResult r = result(log, {recorded_estimate("K", 10, 1)});
    r.sets.front() = EstimateSet{"stage 1", "low", "linear", ""};
    r.sets.front().order = 1;
    r.sets.front().estimates = {recorded_estimate("K", 10, 1)};
    EstimateSet poly{"stage 1", "low", "poly", ""};
    poly.order = order;
    poly.is_selected = true;
    poly.estimates = {recorded_estimate("K1_0", 10, 1)};
    r.sets.push_back(poly);
    return r;
  };
  CHECK(compare(elastic("a", 2), elastic("b", 2), {}).parameters.front().name == "K1_0");
  CHECK(compare(elastic("a", 2), elastic("b", 6), {}).parameters.front().name == "K");
}

TEST_CASE("without a measure of its size an offset is not decided by the margin", "[compare]") {
  RecordedResult a = result("a", {recorded_estimate("offset", 0.030, 0.01)});
  a.sets.front().torque_scale = std::numeric_limits<double>::quiet_NaN();
  RecordedResult b = a;
  b.sets.front().estimates.front().value = 0.031;
  CHECK(compare(a, b, {}).parameters.front().sameness == Sameness::undecided);  // same logs
  b.inputs.front().sha256 = "other";
  CHECK(compare(a, b, {}).parameters.front().sameness == Sameness::undecided);
}

TEST_CASE("a preload that vanished is told", "[compare]") {
  RecordedResult a = result("a", {recorded_estimate("f_s", 10, 1)}),
                 b = result("b", {recorded_estimate("f_s", 10, 1)});
  a.sets.push_back(a.sets.front());
  a.sets.back().preload = "high";
  b.sets.push_back(b.sets.front());
  b.sets.back().preload = "medium";
  const CompareResult r = compare(a, b, {});
  REQUIRE(r.not_compared.size() == 2);
  CHECK(r.not_compared[0].preload == "high");
  CHECK(r.not_compared[1].preload == "medium");
  CHECK(r.warnings ==
        std::vector<std::string>{"2 parameters, preloads or stages could not be compared"});
}

TEST_CASE("asked for by name, orders still have to be the same", "[compare]") {
  RecordedResult a = result("a",
                            {recorded_estimate("K1_0", 10, 1), recorded_estimate("f_sm", 10, 1)}),
                 b = a;
  b.inputs.front().sha256 = "other";
  a.sets.front().order = 2;
  b.sets.front().order = 3;
  const CompareResult r = compare(a, b, {});
  CHECK(r.parameters.size() == 1);
  CHECK(r.not_compared.front().reason ==
        "of order 2 in A, 3 in B: the coefficients are not comparable");
}

TEST_CASE("a preload that is not there", "[compare]") {
  CompareOptions options;
  options.first_preload = options.second_preload = "hgih";
  const RecordedResult a = result("a", {recorded_estimate("f_s", 10, 1)}, "high");
  CHECK(test::message_of([&] { compare(a, a, options); }) ==
        "no preload 'hgih' in a.json; did you mean 'high'?");
}

}  // namespace
}  // namespace cablefit
