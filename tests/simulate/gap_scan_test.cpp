#include "cablefit/simulate/gap_scan.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/simulate/simulator.hpp"

namespace {

using namespace cablefit;

TEST_CASE("block by block as over all rows at once", "[simulate]") {
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(300, 0, 2.99);
  const Eigen::ArrayXd measured = 1e3 + t.sin(), simulated = measured + 0.1 * (7 * t).cos() * t;
  GapScan scan;
  for (Eigen::Index begin = 0; begin < 300; begin += 50) {
    if (begin % 100 == 0) scan.start_window(t(begin));
    scan.add(measured.segment(begin, 50), simulated.segment(begin, 50), t(begin), 0.01);
  }
  const Gap expected = gap(measured, simulated);
  SignalGap result;
  scan.fill(result);
  CHECK(result.rms == Approx(expected.rms).epsilon(1e-12));
  CHECK(result.max_abs == expected.max_abs);
  CHECK(result.relative == Approx(expected.relative).epsilon(1e-9));
  Eigen::Index at = 0;
  (simulated - measured).abs().maxCoeff(&at);
  CHECK(result.t_of_max == Approx(t(at)));
  // The error grows with time, so the last of the three windows is the worst.
  CHECK(result.t_of_worst_window == Approx(2.0));
  CHECK(result.worst_window_rms ==
        Approx(gap(measured.tail(100), simulated.tail(100)).rms).epsilon(1e-12));
}

TEST_CASE("a signal that stands still has no relative gap", "[simulate]") {
  GapScan scan;
  scan.add(Eigen::ArrayXd::Ones(9), Eigen::ArrayXd::Ones(9), 0, 1);
  SignalGap result;
  scan.fill(result);
  CHECK(result.rms == 0);
  CHECK_FALSE(std::isfinite(result.relative));
}

TEST_CASE("tensions: range, slack and closure", "[simulate]") {
  Eigen::ArrayXXd first(2, 2), second(2, 2);
  first << 3, 0, 1, 2;
  second << 0, 5, 0, 0;
  TensionScan scan;
  scan.add(first);
  scan.add(second);
  const std::vector<CableTension> cables = scan.cables(antagonist_pair(2), "N m");
  REQUIRE(cables.size() == 2);
  CHECK(cables[0].cable == "1");
  CHECK(cables[0].min == 0);
  CHECK(cables[0].max == 3);
  CHECK(cables[0].slack_share == 0.5);
  CHECK(cables[1].max == 5);
  CHECK(scan.closure_share() == 0.25);
}

}  // namespace
