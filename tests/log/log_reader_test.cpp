#include "cablefit/log/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/log/log_support.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit {
namespace {

using test::gzipped;
using test::read_all;
using test::TempFolder;
using test::zstd_packed;

// One log in every layout.
struct SameLog {
  std::string csv = "t [ms],q,run\n";
  std::string records = "[";
  std::string channels;

  SameLog() {
    std::string t, q, run;
    for (int i = 0; i < 1000; ++i) {
      const std::string separator = i == 0 ? "" : ",";
      const std::string value = fmt::format("{:.9g}", i * 0.7312345678 - 300);
      const std::string label = fmt::format("\"run, {}\"", i / 100);
      csv += fmt::format("{},{},{}\n", i, value, label);
      records += fmt::format("{}{{\"t [ms]\":{},\"q\":{},\"run\":{}}}", separator, i, value, label);
      t += separator + std::to_string(i);
      q += separator + value;
      run += separator + label;
    }
    records += "]";
    channels = fmt::format(
        "{{\"channels\": {{\"t\": {{\"unit\": \"ms\", \"values\": [{}]}}, \"q\": [{}], "
        "\"run\": [{}]}}}}",
        t, q, run);
  }
};

}  // namespace

TEST_CASE("a log is the same in every format and compression") {
  const TempFolder folder;
  const SameLog same;
  const std::string half = same.csv.substr(0, 5000);
  const std::string other_half = same.csv.substr(5000);
  const auto expected_reader = open_log(folder.write("log.csv", same.csv));
  const auto expected = read_all(*expected_reader, {"t", "q"}, {"run"});
  REQUIRE(expected.numbers[1].size() == 1000);
  for (const std::string& content :
       {same.csv, same.records, same.channels, gzipped(same.csv), zstd_packed(same.csv),
        gzipped(half) + gzipped(other_half), zstd_packed(half) + zstd_packed(other_half),
        gzipped(same.records), zstd_packed(same.channels)}) {
    const auto reader = open_log(folder.write("log", content));
    CHECK(reader->header().columns[0].unit == "ms");
    const auto log = read_all(*reader, {"t", "q"}, {"run"});
    CHECK(log.numbers == expected.numbers);
    CHECK(log.texts == expected.texts);
  }
}

TEST_CASE("files that are no log are refused") {
  const TempFolder folder;
  const auto message = [&](const std::string& content) {
    const std::string path = folder.write("log", content);
    return test::message_of([&] { open_log(path); }, folder.path());
  };
  const std::string empty = "log: file is empty; give a log with a header line and samples";
  CHECK(message("") == empty);
  CHECK(message(gzipped("")) == empty);
  const std::string binary =
      "log: is not text; give CSV or JSON in UTF-8, plain or packed by gzip or zstd";
  CHECK(message(std::string("MATLAB\0\1", 8)) == binary);
  CHECK(message(zstd_packed(std::string("\xff\xfet\0,\0", 6))) ==
        "log: is UTF-16; save it as UTF-8");
  CHECK(test::message_of([] { open_log("no/log.csv"); }) ==
        "cannot read no/log.csv: No such file or directory");
}

TEST_CASE("a packed log that breaks off is an error of next()") {
  const TempFolder folder;
  const SameLog same;
  const std::string packed = gzipped(same.csv);
  const std::string path = folder.write("log.gz", packed.substr(0, packed.size() - 4));
  const std::string message = test::message_of(
      [&] {
        const auto reader = open_log(path);
        read_all(*reader, {"t"});
      },
      folder.path());
  CHECK(message == fmt::format("log.gz: gzip data ends early after {} good bytes; copy the file "
                               "again",
                               same.csv.size()));
}

TEST_CASE("the table of formats has names and descriptions") {
  REQUIRE(log_formats().size() == 3);
  for (const LogFormat& format : log_formats()) {
    CHECK_FALSE(format.name.empty());
    CHECK_FALSE(format.description.empty());
  }
  const auto recognised = [](std::string_view head) {
    const auto formats = log_formats();
    return std::find_if(formats.begin(), formats.end(),
                        [&](const LogFormat& format) { return format.recognises(head); })
        ->name;
  };
  CHECK(recognised("\xef\xbb\xbf \n{\"t\": 0}\n{\"t\": 1}") == "json-lines");
  CHECK(recognised("\xef\xbb\xbf \n{") == "json");
  CHECK(recognised(" [{\"t\": 0}, {\"t\": 1}]") == "json");
  CHECK(recognised("{\"channels\": {\"t\": [0]}}\n") == "json");
  CHECK(recognised("t,q") == "csv");
}

}  // namespace cablefit
