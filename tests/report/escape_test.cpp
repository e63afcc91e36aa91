#include "cablefit/report/parts/escape.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

TEST_CASE("control characters and bad bytes are shown, text is not") {
  CHECK(printable("low") == "low");
  CHECK(printable("\x1b[2J") == "\\x1b[2J");
  CHECK(printable("a\nb\tc") == "a\\x0ab\\x09c");
  CHECK(printable("pr\u00e9charge \u221e") == "pr\u00e9charge \u221e");
  CHECK(printable("\xff\xc3") == "\\xff\\xc3");
  CHECK(printable("\xc2\x9b") == "\\xc2\\x9b");  // a control character terminals obey
  CHECK(n_characters("pr\u00e9") == 3);
}

TEST_CASE("CSV cells are quoted and never formulas") {
  CHECK(csv_cell("low") == "low");
  CHECK(csv_cell("low, bench 3") == "\"low, bench 3\"");
  CHECK(csv_cell("the \"low\" one") == "\"the \"\"low\"\" one\"");
  CHECK(csv_cell("two\nlines") == "\"two\nlines\"");
  CHECK(csv_cell("=1+1") == "'=1+1");
  CHECK(csv_cell("@cmd") == "'@cmd");
  CHECK(csv_cell("+A1") == "'+A1");
  CHECK(csv_cell("-5.2e-3") == "-5.2e-3");
  CHECK(csv_cell("-low") == "'-low");
  CHECK(csv_cell("") == "");
}

TEST_CASE("Markdown shows a text as it is") {
  CHECK(markdown_text("a|b") == "a\\|b");
  CHECK(markdown_text("<b>&") == "&lt;b&gt;&amp;");
  CHECK(markdown_text("*x* `y` \\z") == "\\*x\\* \\`y\\` \\\\z");
  CHECK(markdown_text("[x](http://y)") == "[x]\\(http://y)");
  CHECK(markdown_text("K1_0 [N m/rad]") == "K1_0 [N m/rad]");
  CHECK(markdown_text("a\nb") == "a\\\\x0ab");
}

}  // namespace
