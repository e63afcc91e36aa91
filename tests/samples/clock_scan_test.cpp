// A clock looked at in bulk shows what it shows row by row.
#include "cablefit/samples/survey/clock_scan.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <span>
#include <vector>

namespace {

using namespace cablefit;

/// 1 kHz with 5 % jitter; every `missing`-th row is not there.
std::vector<double> times(std::size_t n, std::size_t missing) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> jitter(-5e-5, 5e-5);
  std::vector<double> t;
  for (std::size_t i = 0; i < n; ++i)
    if (i % missing != missing - 1) t.push_back(1e-3 * static_cast<double>(i) + jitter(random));
  return t;
}

TEST_CASE("times added in bulk count as those added one by one", "[samples]") {
  for (const std::size_t missing : {70, 1000, 100000}) {
    const std::vector<double> t = times(5000, missing);
    ClockScan one_by_one, bulk;
    for (std::size_t i = 0; i < t.size(); ++i) one_by_one.add(t[i], i > 0, "log.csv", i + 2);
    std::size_t in_bulk = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const std::size_t n = i > 0 ? bulk.add_usual(std::span(t).subspan(i)) : 0;
      in_bulk += n;
      i += n;
      if (i < t.size()) bulk.add(t[i], i > 0, "log.csv", i + 2);
    }
    INFO("every " << missing << "th row missing");
    CHECK(in_bulk > 4700);  // all but the first 64 and those behind a gap
    const ClockSurvey a = one_by_one.result(), b = bulk.result();
    CHECK(a.n_rows == b.n_rows);
    CHECK(a.n_gaps == b.n_gaps);
    CHECK(a.t_first == b.t_first);
    CHECK(a.t_last == b.t_last);
    CHECK(a.period == b.period);  // to the last bit: the sums have the same order
    CHECK(a.jitter == b.jitter);
    CHECK(a.worst_jitter == b.worst_jitter);
    CHECK(a.uneven == b.uneven);
  }
}

TEST_CASE("a time that stands still ends what is added in bulk", "[samples]") {
  ClockScan clock;
  std::vector<double> t = times(200, 1000);
  t.push_back(t.back());
  std::size_t i = 0;
  for (; i < 100; ++i) clock.add(t[i], i > 0, "log.csv", i + 2);
  i += clock.add_usual(std::span(t).subspan(i));
  CHECK(i == 200);
  CHECK_THROWS(clock.add(t[i], true, "log.csv", i + 2));
}

}  // namespace
