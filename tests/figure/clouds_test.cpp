// What scatter plots are thinned by: clouds and means, over a range that is not known beforehand.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cablefit/figure/binned_mean.hpp"
#include "cablefit/figure/point_cloud.hpp"

namespace {

using namespace cablefit;

Trace drawn(const PointCloud& cloud) {
  Trace trace;
  cloud.draw(trace);
  return trace;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

TEST_CASE("a cloud keeps its outline and its outliers in constant memory") {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  PointCloud cloud(96, 64);
  double x_max = 0, y_max = 0;
  for (int i = 0; i < 500000; ++i) {
    const double x = normal(random), y = i == 300000 ? 50 : normal(random);
    x_max = std::max(x_max, x);
    y_max = std::max(y_max, y);
    cloud.add(x, y);
  }
  const Trace trace = drawn(cloud);
  CHECK(trace.x.size() <= 96 * 64);
  CHECK(largest(trace.y) == 50);
  CHECK(largest(trace.x) > x_max - 20.0 / 96);  // to within a cell
}

TEST_CASE("points of a cloud are rows of the data, and none is doubled") {
  PointCloud cloud(8, 8);
  for (int i = 0; i < 100; ++i) cloud.add(i % 10, 100 + i % 10);
  const Trace trace = drawn(cloud);
  CHECK(trace.x.size() <= 10);
  for (std::size_t i = 0; i < trace.x.size(); ++i) CHECK(trace.y[i] == 100 + trace.x[i]);
}

TEST_CASE("a cloud of one value, and of missing ones") {
  PointCloud cloud;
  for (int i = 0; i < 1000; ++i) cloud.add(30, 1e-3 * i);
  cloud.add(std::nan(""), 1);
  cloud.add(1, std::nan(""));
  const Trace trace = drawn(cloud);
  CHECK(trace.x.size() > 16);
  CHECK(std::count(trace.x.begin(), trace.x.end(), 30) ==
        static_cast<std::ptrdiff_t>(trace.x.size()));
}

TEST_CASE("means over bins follow a curve, whichever end comes first") {
  for (const double direction : {1.0, -1.0}) {
    BinnedMean mean(200);
    for (int i = -5000; i <= 5000; ++i) {
      const double x = direction * 1e-3 * i;
      mean.add(x, x * x);
    }
    Trace trace;
    mean.draw(trace, 1, false);
    CHECK(trace.x.size() >= 50);
    CHECK(trace.x.size() <= 200);
    CHECK(std::is_sorted(trace.x.begin(), trace.x.end()));
    // Bins are at most 10/50 wide; a mean of squares is above the square of the mean by at most
    // width^2 / 12.
    for (std::size_t i = 0; i < trace.x.size(); ++i)
      CHECK_THAT(trace.y[i], Catch::WithinAbs(trace.x[i] * trace.x[i], 0.2 * 0.2 / 12 + 1e-6));
  }
}

TEST_CASE("bins with few rows are left out and break the line") {
  BinnedMean mean(64);
  for (int i = 0; i < 100; ++i) {
    mean.add(0, 1);
    mean.add(10, 3);
  }
  mean.add(5, 77);
  Trace trace;
  mean.draw(trace, 5, true);
  REQUIRE(trace.x.size() == 3);
  CHECK(trace.y[0] == 1);
  CHECK(std::isnan(trace.y[1]));
  CHECK(trace.y[2] == 3);
}

}  // namespace
