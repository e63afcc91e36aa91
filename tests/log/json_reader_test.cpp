#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "cablefit/log/log_formats.hpp"
#include "cablefit/log/log_reader.hpp"
#include "tests/log/log_support.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using test::read_all;
using test::TempFolder;
using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

std::string open_message(const std::string& text) {
  const TempFolder folder;
  const std::string path = folder.write("log.json", text);
  return test::message_of([&] { open_log(path); }, folder.path());
}

}  // namespace

TEST_CASE("channels are columns") {
  const TempFolder folder;
  const auto reader = open_log(folder.write(
      "log.json",
      "{\"name\": \"a\", \"meta\": {\"x\": [1, {\"channels\": null}]}, \"comment\": null,\n"
      " \"units\": {\"q\": \"deg\"},\n"
      " \"channels\": {\"q\": [1, 2.5, -3e-4], \"tau [mN m]\": [4, 5, 6],\n"
      "  \"theta\": {\"unit\": \"rev\", \"values\": [7, 8, 9]}, \"run\": [\"a\", \"b\", \"a\"]},\n"
      " \"sample_rate\": 1000}"));
  const LogHeader& header = reader->header();
  CHECK(header.sample_rate == 1000.0);
  REQUIRE(header.columns.size() == 4);
  CHECK(header.columns[0].unit == "deg");
  CHECK(header.columns[1].name == "tau");
  CHECK(header.columns[1].unit == "mN m");
  CHECK(header.columns[2].unit == "rev");
  CHECK(to_string(header.columns[2].place) == folder.file("log.json") + ":4:3");
  const auto log = read_all(*reader, {"theta", "q", "tau", "q"}, {"run", "q"});
  CHECK(log.numbers[0] == Numbers{7, 8, 9});
  CHECK(log.numbers[1] == Numbers{1, 2.5, -3e-4});
  CHECK(log.numbers[2] == Numbers{4, 5, 6});
  CHECK(log.numbers[3] == log.numbers[1]);
  CHECK(log.texts[0] == Texts{"a", "b", "a"});
  CHECK(log.texts[1] == Texts{"1", "2.5", "-0.0003"});
  CHECK(log.lines == std::vector<std::uint64_t>{0, 0, 0});
}

TEST_CASE("records are rows, with keys in any order") {
  const TempFolder folder;
  const auto reader = open_log(folder.write("log.json",
                                            "[{\"t\": 0, \"q [deg]\": 1, \"run\": \"a\"},\n"
                                            "\n"
                                            " {\"q [deg]\": 2, \"run\": \"b\", \"t\": 1},\n"
                                            " {\"t\": 2, \"q [deg]\": 3, \"run\": \"a\"}]"));
  CHECK_FALSE(reader->header().sample_rate);
  CHECK(reader->header().columns[1].unit == "deg");
  const auto log = read_all(*reader, {"q", "t"}, {"run"});
  CHECK(log.numbers[0] == Numbers{1, 2, 3});
  CHECK(log.numbers[1] == Numbers{0, 1, 2});
  CHECK(log.texts[0] == Texts{"a", "b", "a"});
  CHECK(log.lines == std::vector<std::uint64_t>{1, 3, 4});
}

TEST_CASE("logs that outgrow memory's share come back from the temporary file") {
  std::string records = "[";
  std::string q;
  constexpr int n_rows = 150'000;  // the spill file keeps 131,072 numbers in memory
  for (int i = 0; i < n_rows; ++i) {
    const char* separator = i == 0 ? "" : ",\n";
    records += fmt::format("{}{{\"t\":{},\"q\":{}}}", separator, i, -i);
    q += fmt::format("{}{}", separator, -i);
  }
  const TempFolder folder;
  const std::string channels = "{\"channels\": {\"p\": [" + q + "], \"q\": [" + q + "]}}";
  for (const std::string& text : {records + "]", channels}) {
    const auto reader = open_log(folder.write("log.json", text));
    const auto log = read_all(*reader, {"q"});
    REQUIRE(log.numbers[0].size() == n_rows);
    bool all_equal = true;
    for (std::size_t i = 0; i < n_rows; ++i) {
      all_equal = all_equal && log.numbers[0][i] == -static_cast<double>(i);
    }
    CHECK(all_equal);
  }
}

TEST_CASE("a temporary folder without room is named") {
  const TempFolder folder;
  std::string text = "{\"channels\": {\"q\": [0";
  for (int i = 0; i < 140'000; ++i) text += ",1";
  const std::string path = folder.write("log.json", text + "]}}");
  ::setenv("TMPDIR", "/no/such/folder", 1);
  const std::string message = test::message_of([&] { open_log(path); });
  ::unsetenv("TMPDIR");
  CHECK(message ==
        "cannot create a temporary file in /no/such/folder: No such file or directory; set TMPDIR "
        "to a folder with room");
}

TEST_CASE("records one a line are read as those of an array") {
  const test::TempFolder folder;
  const std::string path = folder.write("log",
                                        "{\"t\": 0, \"run\": \"{a\\\"\"}\n{\"run\": \"b\", \"t\": "
                                        "1}\r\n\n {\"t\": 2, \"run\": \"b\"}");
  const auto reader = open_log(path);
  const auto log = test::read_all(*reader, {"t"}, {"run"});
  CHECK(log.numbers[0] == std::vector<double>{0, 1, 2});
  CHECK(log.texts[0] == std::vector<std::string>{"{a\"", "b", "b"});
  CHECK(log.lines == std::vector<std::uint64_t>{1, 2, 4});
}

TEST_CASE("a record that is broken is told at its line and column") {
  CHECK(open_message("{\"t\": 0}\n{\"t\": 1}\n{\"t\": x}\n") ==
        "log.json:3:7: no JSON value starts like this; write texts in double quotes, numbers as "
        "1.5 or -3e-4");
  CHECK(open_message("{\"t\": 0}\n{\"q\": 1}\n") == "log.json:2:2: unknown key 'q'; known: t");
  CHECK(open_message("{\"t\": 0}\n{\"t\": 1}\n3\n") ==
        "log.json:3:1: a number among the records; write {\"t\": 0, \"q\": 1}");
}

TEST_CASE("dates of JSON logs are seconds from the first one's midnight") {
  const test::TempFolder folder;
  const auto reader = open_log(folder.write(
      "log", "[{\"t\": \"2026-11-09T10:00:00Z\"}, {\"t\": \"2026-11-10T00:00:00.5Z\"}]"));
  CHECK(reader->header().columns[0].is_date);
  CHECK(test::read_all(*reader, {"t"}).numbers[0] == std::vector<double>{36000, 86400.5});
}

TEST_CASE("values in the wrong place are errors at their start") {
  const std::string number_hint = " is not a number; write numbers as 1.5 or -3e-4";
  CHECK(open_message("{\"channels\": {\"q\": [1,\n null]}}") ==
        std::string("log.json:2:2: null in channel 'q' is not a number; ") + kMissingHint);
  CHECK(open_message("{\"channels\": {\"q\": {\"values\": [true]}}}") ==
        "log.json:1:32: true in channel 'q'" + number_hint);
  CHECK(open_message("{\"channels\": {\"q\": [[1]]}}") ==
        "log.json:1:21: an array in channel 'q'" + number_hint);
  CHECK(open_message("{\"channels\": {\"q\": [{}]}}") ==
        "log.json:1:21: an object in channel 'q'" + number_hint);
  CHECK(open_message("{\"channels\": {\"q\": [1, \"a\"]}}") ==
        "log.json:1:24: column 'q' mixes numbers and texts; write numbers without quotes, texts "
        "with them");
  CHECK(open_message("{\"channels\": {\"q\": 1}}") ==
        "log.json:1:20: channel 'q' is a number, not an array; write it as [0.1, 0.2]");
  CHECK(open_message("{\"channels\": [1]}") ==
        "log.json:1:14: 'channels' is an array; write it as {\"q\": ..}");
  CHECK(open_message("{\"units\": {\"q\": 1}}") ==
        "log.json:1:17: 'q' is a number; write a unit in double quotes");
  CHECK(open_message("{\"channels\": {\"q\": {\"unit\": null}}}") ==
        "log.json:1:29: 'unit' is null; write a unit in double quotes");
  CHECK(open_message("{\"channels\": {\"q\": {\"values\": 1}}}") ==
        "log.json:1:31: 'values' is a number; write it as [0.1, 0.2]");
  CHECK(open_message("{\"sample_rate\": \"1000\"}") ==
        "log.json:1:17: 'sample_rate' is a text; write it in Hz, as 1000");
  CHECK(open_message("{\"sample_rate\": -5}") ==
        "log.json:1:17: 'sample_rate' is -5, not positive; write it in Hz, as 1000");
}

TEST_CASE("keys are checked") {
  CHECK(open_message("{\"chanels\": {}}") ==
        "log.json:1:2: unknown key 'chanels'; did you mean 'channels'?");
  CHECK(open_message("{\"t\": []}") ==
        "log.json:1:2: unknown key 't'; known: channels, sample_rate, units, name, comment, meta");
  CHECK(open_message("{\"channels\": {\"q\": {\"value\": []}}}") ==
        "log.json:1:21: unknown key 'value' in channel 'q'; did you mean 'values'?");
  CHECK(open_message("{\"channels\": {\"q\": {\"unit\": \"rad\"}}}") ==
        "log.json:1:15: channel 'q' has no 'values'; add \"values\": [..]");
  CHECK(open_message("{\"sample_rate\": 1, \"sample_rate\": 2}") ==
        "log.json:1:20: key 'sample_rate' appears twice; keep one of them");
  CHECK(open_message("{\"channels\": {\"q\": {\"values\": [], \"values\": []}}}") ==
        "log.json:1:35: key 'values' in channel 'q' appears twice; keep one of them");
  CHECK(open_message("{\"channels\": {\"q\": [1], \"q [deg]\": [2]}}") ==
        "log.json:1:25: column 'q' appears twice; rename one of them");
  CHECK(open_message("{\"sample_rate\": 1000}") ==
        "log.json:1:1: missing key 'channels'; write {\"channels\": {\"q\": [..]}}");
}

TEST_CASE("channels need one length and one unit") {
  CHECK(open_message("{\"channels\": {\"q\": [1, 2], \"theta\": [1]}}") ==
        "log.json:1:28: channel 'theta' has 1 values, channel 'q' has 2; all channels need one "
        "length");
  CHECK(open_message("{\"units\": {\"tua\": \"deg\"}, \"channels\": {\"tau\": [1]}}") ==
        "log.json:1:19: unit for unknown channel 'tua'; did you mean 'tau'?");
  CHECK(open_message("{\"channels\": {\"q [deg]\": [1]}, \"units\": {\"q\": \"rad\"}}") ==
        "log.json:1:47: channel 'q' has units 'deg' and 'rad'; keep one of them");
}

TEST_CASE("logs without values are refused") {
  CHECK(open_message("{\"channels\": {}}") ==
        "log.json: no column names; name the columns, as t,q,theta,tau");
  CHECK(open_message("{\"channels\": {\"q\": []}}") == "log.json: no values; a log needs samples");
  CHECK(open_message("[]") == "log.json: no records; a log needs samples");
  CHECK(open_message("[{}]") == "log.json: no column names; name the columns, as t,q,theta,tau");
}

TEST_CASE("records need one set of keys") {
  CHECK(open_message("[{\"t\": 0, \"q\": 1},\n {\"t\": 1}]") ==
        std::string(
            "log.json:2:2: record lacks 'q'; every record needs the keys of the first one; ") +
            kMissingHint);
  CHECK(open_message("[{\"t\": 0, \"tau\": 1},\n {\"t\": 1, \"tua\": 1}]") ==
        "log.json:2:11: unknown key 'tua'; did you mean 'tau'?");
  CHECK(open_message("[{\"t\": 0, \"t\": 1}]") ==
        "log.json:1:11: key 't' appears twice; keep one of them");
  CHECK(open_message("[{\"t\": 0},\n {\"t\": 1, \"t\": 1}]") ==
        "log.json:2:11: key 't' appears twice; keep one of them");
  CHECK(open_message("[{\"t\": null}]") ==
        std::string("log.json:1:8: null in column 't' is not a number; ") + kMissingHint);
  CHECK(open_message("[{\"t\": [1]}]") ==
        "log.json:1:8: an array in column 't' is not a number; write numbers as 1.5 or -3e-4");
  CHECK(open_message("[{\"t\": {}}]") ==
        "log.json:1:8: an object in column 't' is not a number; write numbers as 1.5 or -3e-4");
  CHECK(open_message("[{\"t\": 0}, {\"t\": \"a\"}]") ==
        "log.json:1:18: column 't' mixes numbers and texts; write numbers without quotes, texts "
        "with them");
  const std::string hint = " among the records; write {\"t\": 0, \"q\": 1}";
  CHECK(open_message("[1]") == "log.json:1:2: a number" + hint);
  CHECK(open_message("[\"a\"]") == "log.json:1:2: a text" + hint);
  CHECK(open_message("[null]") == "log.json:1:2: null" + hint);
  CHECK(open_message("[[1]]") == "log.json:1:2: an array" + hint);
}

TEST_CASE("a text column cannot be read as numbers") {
  const TempFolder folder;
  const auto reader = open_log(folder.write("log.json", "[{\"run\": \"a\"}]"));
  CHECK(test::message_of([&] { read_all(*reader, {"run"}); }, folder.path()) ==
        "log.json:1:3: column 'run' holds texts, not numbers; write numbers without quotes");
}

TEST_CASE("broken JSON is told with its place") {
  CHECK(open_message("{\"channels\": {\"q\": [1,\n 2") ==
        "log.json:2:3: text ends too early; close all brackets, or copy the file again");
  CHECK(open_message("{\"meta\": " + std::string(100, '[')) ==
        "log.json:1:73: more than 64 levels of brackets; nest the values less deeply");
}

}  // namespace cablefit
