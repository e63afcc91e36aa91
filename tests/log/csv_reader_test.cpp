#include "cablefit/log/csv_reader.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>

#include "cablefit/log/log_formats.hpp"
#include "tests/log/log_support.hpp"
#include "tests/support/message.hpp"

namespace cablefit {
namespace {

using test::read_all;
using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

class TextSource final : public ByteSource {
 public:
  explicit TextSource(std::string text) : text_(std::move(text)) {}
  std::size_t read(char* to, std::size_t n_bytes) override {
    const std::size_t n_read = text_.copy(to, n_bytes, n_given_);
    n_given_ += n_read;
    return n_read;
  }

 private:
  std::string text_;
  std::size_t n_given_ = 0;
};

std::unique_ptr<LogReader> open_text(std::string text, std::size_t block_bytes = 1u << 18,
                                     const LogText& layout = {}) {
  return open_csv(std::make_unique<TextSource>(std::move(text)), "log.csv", layout, block_bytes);
}

std::string read_message(const std::string& text, const std::vector<std::string>& numbers,
                         const std::vector<std::string>& texts = {},
                         std::size_t block_bytes = 1u << 18) {
  return test::message_of([&] {
    const auto reader = open_text(text, block_bytes);
    read_all(*reader, numbers, texts);
  });
}

std::string open_message(const std::string& text) {
  return test::message_of([&] { open_text(text); });
}

}  // namespace

TEST_CASE("every delimiter is read") {
  const std::string text = GENERATE("t,tau,q\n0,1.5,7\n1,-2e-3,8\n",        //
                                    "t;tau;q\n0;1.5;7\n1;-2e-3;8\n",        //
                                    "t\ttau\tq\n0\t1.5\t7\n1\t-2e-3\t8\n",  //
                                    "t tau q\n0 1.5 7\n1 -2e-3 8\n",        //
                                    "  t  tau q \n 0 1.5\t7\n1  -2e-3 8  \n");
  INFO(text);
  const auto reader = open_text(text);
  const auto log = read_all(*reader, {"tau", "t"});
  CHECK(log.numbers[0] == Numbers{1.5, -2e-3});
  CHECK(log.numbers[1] == Numbers{0, 1});
  CHECK(log.lines == std::vector<std::uint64_t>{2, 3});
}

TEST_CASE("comments, blank lines, line ends, byte order mark") {
  const auto reader = open_text(
      "\xef\xbb\xbf# rig 3\r\n\r\nt,tau [mN m]\r\n# first\n0, +1.5\r\n   \n\n 1 ,-2.5e+1 \r\n# "
      "end\n"
      "2,3.");
  CHECK(reader->header().columns[1].name == "tau");
  CHECK(reader->header().columns[1].unit == "mN m");
  CHECK(to_string(reader->header().columns[1].place) == "log.csv:3:3");
  const auto log = read_all(*reader, {"t", "tau"});
  CHECK(log.numbers[0] == Numbers{0, 1, 2});
  CHECK(log.numbers[1] == Numbers{1.5, -25, 3});
  CHECK(log.lines == std::vector<std::uint64_t>{5, 8, 10});
}

TEST_CASE("numbers are read to the last bit") {
  const auto reader =
      open_text("t\n0.1\n1e-400\n4.9e-324\n1.7976931348623157e308\n.5\n\"2.5\"\n-0\n");
  CHECK(read_all(*reader, {"t"}).numbers[0] ==
        Numbers{0.1, 0, 4.9e-324, 1.7976931348623157e308, 0.5, 2.5, -0.0});
}

TEST_CASE("text columns are words") {
  const auto reader = open_text(
      "run,t,phase\nlow,0,blocked\nlow,1,\"moving, fast\"\n high ,2,\nlow,3,\"a \"\"b\"\"\"\n");
  const auto log = read_all(*reader, {"t"}, {"phase", "run", "phase"});
  CHECK(log.texts[0] == Texts{"blocked", "moving, fast", "", "a \"b\""});
  CHECK(log.texts[1] == Texts{"low", "low", "high", "low"});
  CHECK(log.texts[2] == log.texts[0]);
  CHECK(reader->words(1) == Texts{"low", "high"});
}

TEST_CASE("a column may be selected twice, and as number and text") {
  const auto reader = open_text("t,run\n0,1\n1,02\n");
  const auto log = read_all(*reader, {"run", "t", "run"}, {"run"});
  CHECK(log.numbers[0] == Numbers{1, 2});
  CHECK(log.numbers[1] == Numbers{0, 1});
  CHECK(log.numbers[2] == Numbers{1, 2});
  CHECK(log.texts[0] == Texts{"1", "02"});
}

TEST_CASE("cells of columns that are not selected may hold anything") {
  const auto reader = open_text("note,t,x\n\"a,b\",1,nan\n,2,\nabc,3,--\n");
  CHECK(read_all(*reader, {"t"}).numbers[0] == Numbers{1, 2, 3});
}

TEST_CASE("pieces of any size give the same rows") {
  std::string text = "t,run\n";
  for (int i = 0; i < 50; ++i) text += fmt::format("{},{}\n", i, i / 7);
  const std::size_t block_bytes = GENERATE(1, 2, 7, 50, 51, 1u << 20);
  const auto reader = open_text(text, block_bytes);
  const auto log = read_all(*reader, {"t"}, {"run"});
  REQUIRE(log.numbers[0].size() == 50);
  for (std::size_t i = 0; i < 50; ++i) {
    CHECK(log.numbers[0][i] == static_cast<double>(i));
    CHECK(log.texts[0][i] == std::to_string(i / 7));
    CHECK(log.lines[i] == i + 2);
  }
}

TEST_CASE("blocks may end at any byte of the text") {
  std::string text = "t,tau,note\r\n";
  for (int i = 0; i < 40; ++i) text += fmt::format("{},{},\"x, y\"\r\n# c\n", i, i * 0.125);
  for (std::size_t block_bytes = 1; block_bytes <= text.size() + 1; ++block_bytes) {
    const auto reader = open_text(text, block_bytes);
    const auto log = read_all(*reader, {"t", "tau"}, {"note"});
    REQUIRE(log.lines.size() == 40);
    for (std::size_t i = 0; i < 40; ++i) {
      REQUIRE(log.numbers[0][i] == static_cast<double>(i));
      REQUIRE(log.numbers[1][i] == static_cast<double>(i) * 0.125);
      REQUIRE(log.texts[0][i] == "x, y");
      REQUIRE(log.lines[i] == 2 * i + 2);
    }
  }
}

TEST_CASE("numbers are the nearest doubles, however they are written") {
  // strtod of the C library is the judge: it rounds correctly.
  std::mt19937_64 random(4711);
  std::vector<std::string> numbers = {"0",
                                      "-0",
                                      "7.",
                                      ".5",
                                      "-.25",
                                      "1e5",
                                      "1E-3",
                                      "+12",
                                      "1.e2",
                                      "00012.50",
                                      "123456789012345",
                                      "1234567890.12345",
                                      "0.00000000000001",
                                      "9007199254740993",
                                      "0.1",
                                      "-3e-310",
                                      "179769313486231570000000000000000000"};
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 20'000; ++i) {
    const double value = uniform(random) * std::pow(10.0, static_cast<double>(i % 12) - 4);
    numbers.push_back(fmt::format("{:.{}f}", value, i % 17));
    numbers.push_back(fmt::format("{:.{}g}", value, 1 + i % 17));
  }
  std::string text = "x,t\n";
  for (const std::string& number : numbers) text += number + ",0\n";
  const auto log = read_all(*open_text(text), {"x"});
  REQUIRE(log.numbers[0].size() == numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    INFO(numbers[i]);
    const double expected = std::strtod(numbers[i].c_str(), nullptr);
    REQUIRE(std::memcmp(&log.numbers[0][i], &expected, sizeof expected) == 0);
  }
}

TEST_CASE("a long file crosses many blocks") {
  std::string text = "t tau\n";
  for (int i = 0; i < 100'000; ++i) text += fmt::format("{} {}\n", i, -i);
  const auto reader = open_text(text);
  const auto log = read_all(*reader, {"t", "tau"});
  REQUIRE(log.lines.size() == 100'000);
  bool all_equal = true;
  for (std::size_t i = 0; i < log.lines.size(); ++i) {
    const double t = static_cast<double>(i);
    all_equal =
        all_equal && log.numbers[0][i] == t && log.numbers[1][i] == -t && log.lines[i] == i + 2;
  }
  CHECK(all_equal);
}

TEST_CASE("a cell that is no finite number is an error at its place") {
  const std::string hint = "; write numbers as 1.5 or -3e-4";
  const auto tau = [&](const std::string& cell) {
    return read_message("t,tau\n0,1\n1, " + cell + "\n", {"tau", "t"});
  };
  CHECK(tau("abc") == "log.csv:3:4: 'abc' in column 'tau' is not a number" + hint);
  CHECK(tau("1.5x") == "log.csv:3:4: '1.5x' in column 'tau' is not a number" + hint);
  CHECK(tau("nan") ==
        std::string("log.csv:3:4: 'nan' in column 'tau' is not a number; ") + kMissingHint);
  CHECK(tau("-inf") == "log.csv:3:4: '-inf' in column 'tau' is not a number" + hint);
  CHECK(tau("1e999") == "log.csv:3:4: '1e999' in column 'tau' is not a number" + hint);
  CHECK(tau("+-1") == "log.csv:3:4: '+-1' in column 'tau' is not a number" + hint);
  CHECK(tau("0x10") == "log.csv:3:4: '0x10' in column 'tau' is not a number" + hint);
  CHECK(tau("\"x\"") == "log.csv:3:4: 'x' in column 'tau' is not a number" + hint);
  CHECK(tau("") == std::string("log.csv:3:4: empty cell in column 'tau'; ") + kMissingHint);
  CHECK(tau(std::string("\0", 1)) == "log.csv:3:4: '\\x00' in column 'tau' is not a number" + hint);
  CHECK(tau("\"1.5") == "log.csv:3:4: quote is not closed; write a cell as \"a, b\"");
}

TEST_CASE("decimal commas are read where the delimiter leaves them free") {
  const std::string text = GENERATE("t;tau\n0;1\n1;-0,5e3\n2;+1,25\n3;,5\n",  //
                                    "t\ttau\n0\t1\n1\t-0,5e3\n2\t1,25\n3\t0,5\n",
                                    "t tau\n0 1\n1 -0,5e3\n2 1,25\n3 0,5\n");
  INFO(text);
  CHECK(read_all(*open_text(text), {"tau"}).numbers[0] == Numbers{1, -500, 1.25, 0.5});
}

TEST_CASE("points and commas do not mix") {
  CHECK(read_message("t,tau\n0,\"1,5\"\n", {"tau"}) ==
        "log.csv:2:3: '1,5' in column 'tau' is not a number; write the decimal comma as a point, "
        "as in 1.5");
  CHECK(read_message("t;tau\n0;1.5\n1;1,5\n", {"tau"}) ==
        "log.csv:3:3: '1,5' in column 'tau' is not a number; write the decimal comma as a point, "
        "as in 1.5");
  // 20 kB of decimal commas, then a point.
  std::string text = "t;tau\n";
  for (int i = 0; i < 2000; ++i) text += "0,1;1,5\n";
  CHECK(read_message(text + "1;1.5\n", {"tau"}, {}, 64) ==
        "log.csv:2002:3: '1.5' in column 'tau' is not a number; numbers of this log have a decimal "
        "comma, as 1,5 or -3e-4");
}

TEST_CASE("missing cells are NaN where they may miss") {
  const LogText text{0, false, true};
  const auto log =
      read_all(*open_text("t,tau,q\n0,,1\n1, NaN ,2\n2,n/a,\n3,\"\",-\n4,1.5,2\n", 1u << 18, text),
               {"t", "tau", "q"});
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::isnan(log.numbers[1][i]));
  CHECK(log.numbers[1][4] == 1.5);
  CHECK(std::isnan(log.numbers[2][2]));
  CHECK(std::isnan(log.numbers[2][3]));
  CHECK(log.lines == std::vector<std::uint64_t>{2, 3, 4, 5, 6});
  CHECK(test::message_of([&] {
          read_all(*open_text("t,tau\n0,inf\n", 1u << 18, text), {"tau"});
        }) == "log.csv:2:3: 'inf' in column 'tau' is not a number; write numbers as 1.5 or -3e-4");
}

TEST_CASE("dates are seconds from the first one's midnight") {
  const auto reader = open_text(
      "stamp,q\n2026-11-09T23:59:59.5Z,1\n2026-11-10T00:00:00.250Z,2\n"
      "2026-11-10T01:00:00.250+01:00,3\n");
  CHECK(reader->header().columns[0].is_date);
  CHECK_FALSE(reader->header().columns[1].is_date);
  CHECK(read_all(*reader, {"stamp"}).numbers[0] == Numbers{86399.5, 86400.25, 86400.25});
  CHECK(read_message("stamp,q\n2026-11-09T23:59:59Z,1\nnow,2\n", {"stamp"}) ==
        "log.csv:3:1: 'now' in column 'stamp' is not a date; write dates as "
        "2026-11-09T10:00:00.125Z");
}

TEST_CASE("a preamble and a row of units are told with the option that reads them") {
  CHECK(open_message("Bench 3\n\nt,q\n0,1\n") ==
        "log.csv:1: this line is not the header; line 3 names the columns; skip the "
        "lines before it with --skip 2");
  CHECK(open_message("rig,no 3\nt,q\ns,rad\n0,1\n") ==
        "log.csv:1: this line is not the header; line 2 names the columns; skip the "
        "lines before it with --skip 1");
  CHECK(open_message("t,q\n[s],deg\n0,1\n") ==
        "log.csv:2: this line holds units, not numbers; read it as units with "
        "--units-row");
  // What is refused for another reason keeps that reason.
  CHECK(open_message("t,q\na,b\nc,d\n") == "no error");
  CHECK(open_message("t,run\n0,s\n") == "no error");

  const auto skipped = open_text("Bench 3\n\nt,q\n0,1\n", 1u << 18, {2, false, false});
  CHECK(read_all(*skipped, {"q"}).lines == std::vector<std::uint64_t>{4});
  const auto units = open_text("t,q,w (rpm),run\n[ms],deg,,-\n0,1,2,a\n", 1, {0, true, false});
  CHECK(units->header().columns[0].unit == "ms");
  CHECK(units->header().columns[1].unit == "deg");
  CHECK(units->header().columns[2].unit == "rpm");
  CHECK(units->header().columns[3].unit.empty());
  CHECK(read_all(*units, {"q"}).numbers[0] == Numbers{1});
  CHECK(test::message_of([] {
          open_text("t,q\ns\n0,1\n", 1u << 18, {0, true, false});
        }) ==
        "log.csv:2: 1 units of 2 columns; give every column a unit, or leave --units-row out");
}

TEST_CASE("ragged rows are errors, whatever is selected") {
  const std::string hint = "; give every row one cell per column";
  CHECK(read_message("t,q,tau\n0,1,2\n0,1\n", {"t"}) ==
        "log.csv:3: row has 2 cells, the header has 3" + hint);
  CHECK(read_message("t,q\n0,1,2\n", {}) == "log.csv:2: row has 3 cells, the header has 2" + hint);
  CHECK(read_message("t,q\n0,1,\n", {"t"}) ==
        "log.csv:2: row has 3 cells, the header has 2" + hint);
  CHECK(read_message("t q\n0 1 2\n", {"t"}) ==
        "log.csv:2: row has 3 cells, the header has 2" + hint);
  CHECK(read_message("t q\n0\n", {"t"}) == "log.csv:2: row has 1 cell, the header has 2" + hint);
}

TEST_CASE("header lines that name nothing are refused") {
  CHECK(open_message("0,1,2\n3,4,5\n") ==
        "log.csv:1: no header line; the first line holds numbers only; name the "
        "columns, as t,q,theta,tau (a line that starts with # is a comment)");
  CHECK(open_message("# only\n\n") ==
        "log.csv: no header line; name the columns, as t,q,theta,tau");
  CHECK(open_message(",,\n1,2,3\n") ==
        "log.csv:1: no column names; name the columns, as t,q,theta,tau");
  CHECK(open_message("t,q [deg],q (rad)\n") ==
        "log.csv:1:11: column 'q' appears twice; rename one of them");
}

TEST_CASE("a header without rows is an error of the first next()") {
  CHECK(open_message("t,q\n") == "no error");
  CHECK(read_message("t,q\n# end\n", {"t"}) ==
        "log.csv: no rows after the header; a log needs samples");
}

TEST_CASE("lines, columns and words are bounded") {
  const std::string megabyte(1u << 20, 'x');
  CHECK(open_message(megabyte + "x,t\n1,2\n") ==
        "log.csv:1: line is longer than 1 MiB; a log has one line per sample");
  CHECK(open_message(megabyte + megabyte + megabyte) ==
        "log.csv:1: line is longer than 1 MiB; a log has one line per sample");
  CHECK(read_message("t,note\n0,a\n1," + megabyte + "\n", {"t"}) ==
        "log.csv:3: line is longer than 1 MiB; a log has one line per sample");
  CHECK(read_message("t,note\n0,a\n1," + megabyte.substr(2) + "\n", {"t"}) == "no error");

  std::string wide = "c0";
  for (int i = 1; i <= 10'000; ++i) wide += fmt::format(",c{}", i);
  CHECK(open_message(wide) ==
        "log.csv:1: more than 10000 columns; is this a log with one row per sample?");

  std::string distinct = "t,stamp\n";
  for (int i = 0; i < 100'000; ++i) distinct += fmt::format("0,{}\n", i);
  CHECK(read_message(distinct, {"t"}, {"stamp"}) ==
        "log.csv:1:3: column 'stamp' holds more than 99999 different texts, or 16 MiB of them; "
        "use a column of labels, one per run");
}

TEST_CASE("a hostile header costs no more than its length") {
  const std::string brackets(1'000'000, '[');
  CHECK(open_message(brackets + ",t\n") == "no error");
  std::string quotes = "t";
  for (int i = 0; i < 2'000; ++i) quotes += ",\"\"\"";
  CHECK(open_message(quotes) != "");
}

}  // namespace cablefit
