// A log from memory is the log that a file with the same columns would be.
#include "cablefit/samples/survey/memory_log.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "cablefit/base/error.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

struct Arrays {
  std::vector<double> t, q, theta, tau;
};

Arrays some_motion() {
  Arrays a;
  for (int i = 0; i < 500; ++i) {
    const double t = 2e-3 * i;
    a.t.push_back(1e3 * t);  // ms
    a.q.push_back(0.3 * std::sin(5 * t));
    a.theta.push_back((0.31 * std::sin(5 * t + 0.02)) * 180 / std::numbers::pi);
    a.tau.push_back(2 * std::cos(5 * t));
  }
  return a;
}

std::vector<MemoryColumn> columns_of(const Arrays& a) {
  return {{"t [ms]", a.t}, {"q", a.q}, {"theta [deg]", a.theta}, {"tau", a.tau}};
}

TEST_CASE("a log from memory has the units and the phase of a file", "[samples]") {
  const Arrays a = some_motion();
  Columns file;
  file.columns = {{"t [ms]", a.t}, {"q", a.q}, {"theta [deg]", a.theta}, {"tau", a.tau}};
  Bench bench;
  bench.add_text(file.csv());
  const LogSurvey read = bench.logs().front();
  const LogSurvey memory = survey_memory("memory", columns_of(a), default_rig());
  CHECK(memory.n_rows == read.n_rows);
  REQUIRE(memory.parts.size() == 1);
  CHECK(memory.parts[0].phase == Phase::moving);
  CHECK(memory.parts[0].preload == read.parts[0].preload);
  // The text of the file has 17 digits or fewer.
  CHECK(memory.parts[0].period == Approx(read.parts[0].period).epsilon(1e-12));
  for (std::size_t k = 0; k < read.parts[0].channels.size(); ++k) {
    CHECK(memory.parts[0].channels[k].min == Approx(read.parts[0].channels[k].min).epsilon(1e-9));
    CHECK(memory.parts[0].channels[k].max == Approx(read.parts[0].channels[k].max).epsilon(1e-9));
  }
}

TEST_CASE("a link that stands still makes a log from memory a blocked one", "[samples]") {
  Arrays a = some_motion();
  std::fill(a.q.begin(), a.q.end(), 0.0);
  CHECK(survey_memory("memory", columns_of(a), default_rig()).parts[0].phase == Phase::blocked);
}

TEST_CASE("a log from memory without a clock has a rate", "[samples]") {
  const Arrays a = some_motion();
  const std::vector<MemoryColumn> columns = {{"q", a.q}, {"theta [deg]", a.theta}};
  CHECK(survey_memory("memory", columns, default_rig(), 500).parts[0].period == Approx(2e-3));
  CHECK_THROWS_AS(survey_memory("memory", columns, default_rig()), Error);
}

TEST_CASE("what cannot be a log from memory is refused by its column", "[samples]") {
  Arrays a = some_motion();
  a.tau.pop_back();
  CHECK_THROWS_WITH(survey_memory("arm", columns_of(a), default_rig()),
                    "arm: column 'tau' has 499 values, 't [ms]' has 500; one value per row in "
                    "every column");
  a.tau.push_back(std::nan(""));
  CHECK_THROWS_WITH(survey_memory("arm", columns_of(a), default_rig()),
                    "arm:500: column 'tau' is not finite; leave the row out");
  const std::vector<double> few(4, 0.0);
  const std::vector<MemoryColumn> columns = {{"t", few}, {"q", few}};
  CHECK_THROWS_WITH(survey_memory("arm", columns, default_rig()),
                    "arm: 4 rows; a log has at least 8");
}

}  // namespace
