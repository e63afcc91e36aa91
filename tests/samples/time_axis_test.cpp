#include "cablefit/samples/rows/time_axis.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

LogSurvey log_of(const std::string& path, double t_first, double t_last, double period) {
  PartSurvey part;
  part.t_first = t_first;
  part.t_last = t_last;
  part.period = period;
  LogSurvey log;
  log.plan.path = path;
  log.parts = {part};
  return log;
}

bool all(const PartSurvey&) { return true; }

TEST_CASE("one log keeps its times") {
  const std::vector<LogSurvey> logs = {log_of("a.csv", 100, 110, 1e-2)};
  const TimeAxis time(logs, all, 1);
  CHECK(time.at(0, 0, 103) == 103);
  CHECK(time.marks().empty());
  CHECK(time.axis().title == "time");
  CHECK(!time.has_close_up());  // 1000 rows are drawn as they are
  CHECK(!time.in_close_up(105));
}

TEST_CASE("several logs follow each other from 0 on") {
  const std::vector<LogSurvey> logs = {log_of("x/a.csv", 100, 110, 1e-3),
                                       log_of("x/b.csv", 5, 25, 2e-3)};
  const TimeAxis time(logs, all, 2);
  CHECK(time.at(0, 0, 100) == 0);
  CHECK(time.at(1, 0, 5) == 10);
  CHECK(time.at(1, 0, 25) == 30);
  REQUIRE(time.marks().size() == 2);
  CHECK(time.marks()[1].x == 10);
  CHECK(time.marks()[1].text == "b.csv");
  CHECK(time.spacing() == 4e-3);  // the wider of the two
}

TEST_CASE("a close-up lies within the longest log") {
  const std::vector<LogSurvey> logs = {log_of("a.csv", 0, 100, 1e-3),
                                       log_of("b.csv", 0, 500, 1e-3)};
  const TimeAxis time(logs, all, 1);
  REQUIRE(time.has_close_up());
  CHECK(time.in_close_up(350.5));  // 250.5 s into the second
  CHECK(!time.in_close_up(349));
  CHECK(!time.in_close_up(352));
}

}  // namespace
