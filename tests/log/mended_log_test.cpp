#include "cablefit/log/mended_log.hpp"

#include <catch2/catch.hpp>

#include "cablefit/log/iso_time.hpp"
#include "tests/log/log_support.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using Numbers = std::vector<double>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Read {
  test::WholeLog log;
  MendedCounts counts;
};

Read read(const std::string& text, const MendingRules& rules,
          const std::vector<std::string>& texts = {}) {
  const test::TempFolder folder;
  const LogText layout{0, false, rules.missing != Missing::refuse};
  MendedLog log(open_log(folder.write("log", text), layout), rules, 0);
  Read result;
  result.log = test::read_all(log, {"t", "q"}, texts);
  result.counts = log.counts();
  return result;
}

TEST_CASE("rows with missing cells are left out and counted") {
  const Read all = read("t,q\n0,1\n1,\n,3\n3,4\n", {Missing::drop, false});
  CHECK(all.log.numbers[0] == Numbers{0, 3});
  CHECK(all.log.numbers[1] == Numbers{1, 4});
  CHECK(all.log.lines == std::vector<std::uint64_t>{2, 5});
  CHECK(all.counts.rows_missing == 2);
  CHECK(all.counts.cells_held == 0);
  CHECK(all.counts.rows_kept == 2);
  CHECK(all.counts.n_rows() == 4);
  CHECK(all.counts.cells_missing == std::vector<std::size_t>{1, 1});
}

TEST_CASE("missing cells hold the value before, where there is one") {
  const Read all = read("t,q\n0,\n1,1\n2,nan\n3,null\nnan,5\n4,6\n", {Missing::hold, false});
  CHECK(all.log.numbers[0] == Numbers{1, 2, 3, 4});
  CHECK(all.log.numbers[1] == Numbers{1, 1, 1, 6});
  CHECK(all.counts.rows_missing == 2);  // nothing before it; no time
  CHECK(all.counts.cells_held == 2);
}

TEST_CASE("a value is not held into another run") {
  const Read all = read("t,q,run\n0,1,a\n1,,a\n0,,b\n1,2,b\n", {Missing::hold, false}, {"run"});
  CHECK(all.log.numbers[1] == Numbers{1, 1, 2});
  CHECK(all.counts.rows_missing == 1);
}

TEST_CASE("of repeated times the first row stays") {
  const Read all =
      read("t,q,run\n0,1,a\n0,2,a\n1,3,a\n1,4,a\n1,5,b\n", {Missing::refuse, true}, {"run"});
  CHECK(all.log.numbers[0] == Numbers{0, 1, 1});
  CHECK(all.log.numbers[1] == Numbers{1, 3, 5});
  CHECK(all.counts.rows_repeated == 2);
}

TEST_CASE("without rules everything is as it stands") {
  const Read all = read("t,q\n0,1\n0,2\n", {});
  CHECK(all.log.numbers[1] == Numbers{1, 2});
}

TEST_CASE("null and lacking keys of JSON records are missing cells") {
  const std::string text =
      GENERATE("[{\"t\": 0, \"q\": 1}, {\"t\": 1, \"q\": null}, {\"t\": 2}, {\"t\": 3, \"q\": 4}]",
               "{\"t\": 0, \"q\": 1}\n{\"t\": 1, \"q\": null}\n{\"t\": 2}\n{\"t\": 3, \"q\": 4}\n",
               "{\"channels\": {\"t\": [0, 1, 2, 3], \"q\": [1, null, null, 4]}}");
  const Read all = read(text, {Missing::drop, false});
  CHECK(all.log.numbers[0] == Numbers{0, 3});
  CHECK(all.log.numbers[1] == Numbers{1, 4});
  CHECK(all.counts.rows_missing == 2);
}

TEST_CASE("rows that are left out keep their places") {
  const test::TempFolder folder;
  MendedLog log(open_log(folder.write("log", "q\n1\n\"\"\n3\n"), {0, false, true}),
                {Missing::drop, false}, std::nullopt);
  log.select({0}, {});
  LogChunk chunk;
  REQUIRE(log.next(chunk));
  CHECK(chunk.first_row == 0);
  CHECK(chunk.n_rows == 2);
  CHECK(chunk.offsets == std::vector<std::size_t>{0, 2});
}

TEST_CASE("a row left out of one piece does not move those of the next") {
  std::string text = "[";
  for (int i = 0; i < 20'000; ++i)
    text += (i == 0 ? "" : ",") +
            (i == 5 ? std::string("{\"q\": null}") : "{\"q\": " + std::to_string(i) + "}");
  const test::TempFolder folder;
  MendedLog log(open_log(folder.write("log", text + "]"), {0, false, true}), {Missing::drop, false},
                std::nullopt);
  log.select({0}, {});
  LogChunk chunk;
  std::size_t n_rows = 0;
  while (log.next(chunk)) {
    for (std::size_t i = 0; i < chunk.n_rows; ++i) {
      const std::size_t row = chunk.first_row + (chunk.offsets.empty() ? i : chunk.offsets.at(i));
      REQUIRE(chunk.numbers[0][i] == static_cast<double>(row));
    }
    n_rows += chunk.n_rows;
  }
  CHECK(n_rows == 19'999);
}

TEST_CASE("a missing label is none") {
  const test::TempFolder folder;
  const auto log =
      open_log(folder.write("log", "[{\"t\": 0, \"run\": null}, {\"t\": 1, \"run\": \"a\"}]"),
               {0, false, true});
  CHECK(test::read_all(*log, {"t"}, {"run"}).texts[0] == std::vector<std::string>{"", "a"});
}

TEST_CASE("ISO 8601 times") {
  const auto seconds = [](const char* text) {
    const auto time = read_iso_time(text);
    return time ? seconds_from(*time, 20'000) : kNan;
  };
  CHECK(seconds("2024-10-04T00:00") == 0);  // day 20,000 by `date -d @1728000000`
  CHECK(seconds("2024-10-04 10:00:00.125") == 36'000.125);
  CHECK(seconds("2024-10-04T10:00:00,5Z") == 36'000.5);
  CHECK(seconds("2024-10-04T10:00:00+02:00") == 28'800);
  CHECK(seconds("2024-10-03T23:00:00-0230") == 5400);
  for (const char* text : {"", "2024-10-04", "2024-13-04T00:00", "2024-02-30T00:00",
                           "2024-10-04T25:00", "2024-10-04T10:00:00.", "2024-10-04T10:00x",
                           "20241004T1000", "2024-10-04T10:00:00.1234567890123456789"})
    CHECK_FALSE(read_iso_time(text).has_value());
}

}  // namespace
}  // namespace cablefit
