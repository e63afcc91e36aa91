#include "cablefit/figure/thinned_line.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;

constexpr double kRate = 1000;

Trace drawn(const ThinnedLine& line) {
  Trace trace;
  line.draw(trace);
  return trace;
}

std::size_t n_breaks(const Trace& trace) {
  return static_cast<std::size_t>(
      std::count_if(trace.y.begin(), trace.y.end(), [](double y) { return std::isnan(y); }));
}

bool has(const Trace& trace, double t, double value) {
  for (std::size_t i = 0; i < trace.x.size(); ++i)
    if (trace.x[i] == t && trace.y[i] == value) return true;
  return false;
}

TEST_CASE("thinning keeps the least and the greatest value, at their times") {
  const int n = 300000;
  ThinnedLine line(0, (n - 1) / kRate, 1 / kRate);
  for (int i = 0; i < n; ++i) {
    const double value = i == 123456 ? 7 : i == 222222 ? -9 : std::sin(1e-3 * i);
    line.add(i / kRate, value);
  }
  const Trace trace = drawn(line);
  CHECK(has(trace, 123456 / kRate, 7));
  CHECK(has(trace, 222222 / kRate, -9));
  CHECK(std::is_sorted(trace.x.begin(), trace.x.end()));
  CHECK(n_breaks(trace) == 0);
}

TEST_CASE("what is drawn does not grow with the rows") {
  for (const int n : {10000, 1000000}) {
    ThinnedLine line(0, (n - 1) / kRate, 1 / kRate);
    for (int i = 0; i < n; ++i) line.add(i / kRate, i % 7);
    const Trace trace = drawn(line);
    CHECK(trace.x.size() <= 2 * kMostBuckets);
    CHECK(trace.x.size() > kMostBuckets);
    CHECK(trace.x.size() == trace.y.size());
  }
}

TEST_CASE("a short signal is drawn row by row") {
  ThinnedLine line(2, 2 + 9 / kRate, 1 / kRate);
  for (int i = 0; i < 10; ++i) line.add(2 + i / kRate, i * i);
  const Trace trace = drawn(line);
  CHECK(trace.y == std::vector<double>{0, 1, 4, 9, 16, 25, 36, 49, 64, 81});
  CHECK(trace.x.front() == 2);
}

TEST_CASE("missing samples break the line") {
  ThinnedLine line(0, 10, 1 / kRate);
  for (int i = 0; i <= 10000; ++i) {
    const double t = i / kRate;
    const bool is_missing = (t > 2 && t < 2.5) || (t > 7 && t < 9);
    line.add(t, is_missing ? std::nan("") : t);
  }
  const Trace trace = drawn(line);
  CHECK(n_breaks(trace) == 2);
  for (std::size_t i = 0; i < trace.x.size(); ++i)
    if (std::isnan(trace.y[i])) CHECK((trace.x[i] < 2.6 || trace.x[i] > 6.9));
}

TEST_CASE("a jitter of the clock is no hole") {
  ThinnedLine line(0, 100, 1e-3);
  for (int i = 0; i <= 100000; ++i) line.add(1e-3 * i, 1);  // 1e-3 * i is not i / 1000
  CHECK(n_breaks(drawn(line)) == 0);
}

TEST_CASE("a row between two holes can still be seen") {
  ThinnedLine line(0, 100, 1e-3);
  line.add(10, 1);
  line.add(50, 2);
  const Trace trace = drawn(line);
  CHECK(n_breaks(trace) == 2);
  CHECK(std::count(trace.y.begin(), trace.y.end(), 2) == 2);  // a dash, not a point
}

TEST_CASE("the order of rows does not matter, and outliers in time stay at the ends") {
  ThinnedLine line(0, 10, 1);
  for (const double t : {9.0, 3.0, -5.0, 20.0}) line.add(t, t);
  CHECK(has(drawn(line), -5, -5));
  CHECK(has(drawn(line), 20, 20));
}

TEST_CASE("no rows, no points") { CHECK(drawn(ThinnedLine(0, 10, 1)).x.empty()); }

}  // namespace
