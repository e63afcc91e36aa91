#include "cablefit/refine/bounded_work.hpp"

#include <catch2/catch.hpp>

#include "tests/support/message.hpp"

namespace cablefit {
namespace {

LogSurvey log_of(double rate, double seconds, Phase phase = Phase::moving) {
  LogSurvey log;
  log.plan.path = "a.csv";
  PartSurvey part;
  part.phase = phase;
  part.period = 1 / rate;
  part.n_rows = static_cast<std::size_t>(seconds * rate);
  log.parts = {part};
  return log;
}

std::string message(const std::vector<LogSurvey>& train) {
  RefineLogs logs;
  logs.train = train;
  return test::message_of([&] { require_bounded_work(logs); });
}

TEST_CASE("slow logs that are long are refused before any work") {
  CHECK(message({log_of(10, 9600)}) ==
        "a.csv: refine would take too long: 9600 s at 10 Hz; record at 100 Hz or more, or give at "
        "most 1000 s");
  CHECK(message({log_of(10, 600), log_of(20, 600)}) ==
        "a.csv: refine would take too long: 1200 s at 20 Hz; record at 100 Hz or more, or give at "
        "most 1000 s");
}

TEST_CASE("fast, short and blocked logs are searched") {
  CHECK(message({log_of(1000, 9600)}) == "no error");
  CHECK(message({log_of(10, 900)}) == "no error");
  CHECK(message({log_of(10, 9600, Phase::blocked)}) == "no error");
}

}  // namespace
}  // namespace cablefit
