// The direction of the last motion: ramps, reversals, plateaus, noise at rest.
#include "tests/samples/rows_of_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Approach of every row of a theta-only log.
std::vector<double> approach_of(const std::vector<double>& theta) {
  Columns log{{{"t", {}}, {"theta", {}}}};
  for (std::size_t i = 0; i < theta.size(); ++i) {
    log.columns[0].second.push_back(0.01 * static_cast<double>(i));
    log.columns[1].second.push_back(theta[i]);
  }
  Bench bench;
  const LogSurvey& survey = bench.add_text(log.csv());
  std::vector<double> all;
  for_each_window(survey, kAllParts, 10, 1, 0, [&](Window&& w) {
    for (Eigen::Index i = w.begin; i < w.end; ++i) all.push_back(w.approach(i - w.first, 0));
    return true;
  });
  return all;
}

// Up 0..0.1, hold, up to 0.2, hold, down to 0, hold; 200 rows each, noise of one 10000th of it.
TEST_CASE("approach keeps the direction over plateaus and turns at reversals", "[samples]") {
  Normal noise(5100);
  const double levels[] = {0, 0.1, 0.1, 0.2, 0.2, 0, 0};
  std::vector<double> theta;
  for (int leg = 0; leg < 6; ++leg)
    for (int i = 0; i < 200; ++i)
      theta.push_back(levels[leg] + (levels[leg + 1] - levels[leg]) * i / 200 + 1e-5 * noise());
  const std::vector<double> approach = approach_of(theta);
  REQUIRE(approach.size() == theta.size());
  CHECK(approach.front() == 0);
  // A ramp of 5e-4 per row passes the band (1e-3 of the range, 8 sd) within two rows.
  for (std::size_t i = 5; i < 800; ++i) {
    INFO("row " << i);
    CHECK(approach[i] == 1);
  }
  for (std::size_t i = 805; i < 1200; ++i) {
    INFO("row " << i);
    CHECK(approach[i] == -1);
  }
}

TEST_CASE("noise at rest is no motion", "[samples]") {
  Normal noise(5101);
  std::vector<double> theta;
  for (int i = 0; i < 500; ++i) theta.push_back(0.3 + 1e-5 * noise());
  // All the log is noise: its band is 8 sd, its range about 6.5.
  for (const double a : approach_of(theta)) CHECK(a == 0);
}

TEST_CASE("the first motion may be downwards", "[samples]") {
  std::vector<double> theta;
  for (int i = 0; i < 300; ++i) theta.push_back(i < 100 ? 0 : -1e-3 * (i - 100));
  const std::vector<double> approach = approach_of(theta);
  for (std::size_t i = 0; i < 100; ++i) CHECK(approach[i] == 0);
  for (std::size_t i = 110; i < 300; ++i) CHECK(approach[i] == -1);
}

}  // namespace
