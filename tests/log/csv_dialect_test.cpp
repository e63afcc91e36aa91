#include "cablefit/log/csv_dialect.hpp"

#include <catch2/catch.hpp>

namespace cablefit {
namespace {

std::vector<std::string> header_texts(std::string_view line) {
  std::vector<std::string> texts;
  for (const Cell& cell : split_header(line, find_delimiter(line), 100)) texts.push_back(cell.text);
  return texts;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("the delimiter is found outside brackets and quotes") {
  CHECK(find_delimiter("t,q,tau") == Delimiter::comma);
  CHECK(find_delimiter("t;q;tau") == Delimiter::semicolon);
  CHECK(find_delimiter("t\tq\ttau") == Delimiter::tab);
  CHECK(find_delimiter("t q  tau") == Delimiter::blanks);
  CHECK(find_delimiter("tau") == Delimiter::blanks);
  CHECK(find_delimiter("theta [deg],tau (mN m)") == Delimiter::comma);
  CHECK(find_delimiter("t (a,b,c);q") == Delimiter::semicolon);
  CHECK(find_delimiter("\"t,x,y\";q") == Delimiter::semicolon);
  CHECK(find_delimiter("t [s;q (") == Delimiter::semicolon);
}

TEST_CASE("header cells keep what stands in brackets") {
  CHECK(header_texts("theta [deg], tau (mN m)") == Texts{"theta [deg]", "tau (mN m)"});
  CHECK(header_texts("t theta [deg] tau (mN m) q") == Texts{"t", "theta [deg]", "tau (mN m)", "q"});
  CHECK(header_texts("theta [deg]") == Texts{"theta [deg]"});
  CHECK(header_texts("\"t\",\"q, \"\"left\"\"\"") == Texts{"t", "q, \"left\""});
  CHECK(header_texts("t [s,q") == Texts{"t [s", "q"});
  CHECK(header_texts(",t,q,") == Texts{"", "t", "q", ""});
  CHECK(header_texts("  t  q  ") == Texts{"t", "q"});
  CHECK(header_texts("t\t\tq") == Texts{"t", "", "q"});
}

TEST_CASE("cells know where they stand") {
  const auto cells = split_row("1, \"a, b\" ,3", Delimiter::comma);
  REQUIRE(cells.size() == 3);
  CHECK(cells[1].text == "a, b");
  CHECK(cells[1].offset == 3);
  CHECK(cells[2].offset == 11);
}

TEST_CASE("comments and blank lines are skipped") {
  CHECK(is_skipped_line("", Delimiter::comma));
  CHECK(is_skipped_line(" \t", Delimiter::comma));
  CHECK(is_skipped_line("  # note", Delimiter::comma));
  CHECK_FALSE(is_skipped_line("\t\t", Delimiter::tab));
  CHECK_FALSE(is_skipped_line(",,", Delimiter::comma));
}

}  // namespace cablefit
