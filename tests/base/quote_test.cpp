#include "cablefit/base/quote.hpp"

#include <catch2/catch.hpp>

namespace cablefit {

TEST_CASE("quoted text is safe to print") {
  CHECK(in_quotes("tau") == "'tau'");
  CHECK(in_quotes("") == "''");
  CHECK(in_quotes("a\tb\x1b[31m") == "'a\\x09b\\x1b[31m'");
  CHECK(in_quotes("θ [°]") == "'θ [°]'");
  CHECK(in_quotes("\xb0") == "'\\xb0'");
  CHECK(in_quotes("\xc2\x9b") == "'\\xc2\\x9b'");
  CHECK(in_quotes("\xce") == "'\\xce'");
}

TEST_CASE("quoted text is cut at 60 bytes, never inside a character") {
  CHECK(in_quotes(std::string(60, 'x')) == "'" + std::string(60, 'x') + "'");
  CHECK(in_quotes(std::string(61, 'x')) == "'" + std::string(60, 'x') + "...'");
  CHECK(in_quotes(std::string(59, 'x') + "θ") == "'" + std::string(59, 'x') + "...'");
}

TEST_CASE("what a careless decoder would take for a control character is no character") {
  CHECK(printable("\xe0\x80\x9b[2J") == "\\xe0\\x80\\x9b[2J");     // an escape in three bytes
  CHECK(printable("\xf0\x80\x80\x9b") == "\\xf0\\x80\\x80\\x9b");  // and in four
  CHECK(printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // half a pair of UTF-16
  CHECK(printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  CHECK(printable("\xe0\xa4\xb9 \xf0\x9f\x98\x80") == "\xe0\xa4\xb9 \xf0\x9f\x98\x80");
  CHECK(printable(std::string(100, 'x') + '\n') == std::string(100, 'x') + "\\x0a");
}

TEST_CASE("marks that turn the direction of text are escaped, letters stay") {
  CHECK(printable("low\u202Egpj.csv") == "low\\xe2\\x80\\xaegpj.csv");  // right-to-left override
  for (const char* mark : {"\u061C", "\u200E", "\u200F", "\u202A", "\u202D", "\u2066", "\u2069"}) {
    INFO(mark);
    CHECK(printable(std::string("a") + mark + "b").starts_with("a\\x"));
  }
  CHECK(printable("\u200D\u2010 \u2065") == "\u200D\u2010 \u2065");  // neighbours of those marks
  CHECK(printable("\u05E9\u05DC") == "\u05E9\u05DC");
  CHECK(shortened("a\u202Eb") == "a\\xe2\\x80\\xaeb");
}

TEST_CASE("letters from right to left stand alone") {
  CHECK(isolated("low, 3.2 N m") == "low, 3.2 N m");
  CHECK(isolated("\u05E9\u05DC: 3.2 N m") == "\u2068\u05E9\u05DC\u2069: 3.2 N m");
  CHECK(isolated("cable \u0627") == "cable \u2068\u0627\u2069");
  CHECK(isolated("\u0627 1 \u0627") == "\u2068\u0627\u2069 1 \u2068\u0627\u2069");
  CHECK(isolated("\u03B8 \u2212 q \U0001F600") == "\u03B8 \u2212 q \U0001F600");
  CHECK(isolated("").empty());
}

}  // namespace cablefit
