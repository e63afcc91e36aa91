#include "cablefit/report/writers/writers.hpp"

#include <catch2/catch.hpp>

#include "cablefit/report/page/page_parts.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using test::message_of;

Document document() {
  Document d;
  d.title = "A title";
  d.tables = {{"Numbers",
               {{"", "name", "", true}, {"group", "a", "N m"}, {"group", "rsd", ""}},
               {{"low", "1.5", "12"}, {"higher|", "-", "3.25"}},
               {"[1] a note"}},
              {"Details", {{"", "x", ""}}, {{"1"}}, {}, true}};
  d.paragraphs = {"a paragraph", "another"};
  d.decisions = {{{}, "cut-off", "10 Hz", "quasi-static"}, {{"low", "high"}, "order", "2", ""}};
  d.warnings = {"look\x1b here"};
  d.tidy.columns = {{"", "name", ""}, {"", "value", ""}};
  d.tidy.rows = {{"a,b", "1.5"}, {"=c", ""}};
  return d;
}

TEST_CASE("a document as text") {
  CHECK(write_text(without_details(document())) ==
        "A title\n"
        "\n"
        "Numbers\n"
        "\n"
        "            group\n"
        "name         a   rsd\n"
        "         [N m]\n"
        "--------------------\n"
        "low        1.5    12\n"
        "higher|      -  3.25\n"
        "[1] a note\n"
        "\n"
        "a paragraph\n"
        "another\n"
        "\n"
        "Choices\n"
        "  cut-off = 10 Hz (quasi-static)\n"
        "  low, high: order = 2\n"
        "\n"
        "warning: look\\x1b here\n");
}

TEST_CASE("a summary stands before the tables, its texts beside their labels") {
  Document d;
  d.title = "A title";
  const std::string word(60, 'x');
  d.summary = {{"gap", word + " " + word + " end"}, {"verdict", "named\x1b"}};
  d.tables = {{"Numbers", {{"", "x", ""}}, {{"1"}}, {}}};
  CHECK(write_text(d) == "A title\n\ngap      " + word + "\n         " + word +
                             " end\nverdict  named\\x1b\n\nNumbers\n\nx\n-\n1\n");
  CHECK_THAT(write_markdown(d),
             Catch::Matchers::StartsWith("# A title\n\n- **gap**: " + word + " " + word +
                                         " end\n- **verdict**: named\\\\x1b\n\n## Numbers\n"));
}

TEST_CASE("a long label of a summary has a line of its own") {
  Document d;
  d.title = "A title";
  const std::string label(30, 'y');
  d.summary = {{"gap", "0.1 N m"}, {label, "none"}};
  d.tables = {{"Numbers", {{"", "x", ""}}, {{"1"}}, {}}};
  CHECK(write_text(d) ==
        "A title\n\ngap  0.1 N m\n" + label + "\n     none\n\nNumbers\n\nx\n-\n1\n");
}

TEST_CASE("details are for files") {
  CHECK_THAT(write_text(document()), Catch::Matchers::Contains("Details\n\nx\n-\n1\n"));
}

TEST_CASE("a document as CSV") {
  CHECK(write_csv(document()) == "name,value\n\"a,b\",1.5\n'=c,\n");
}

TEST_CASE("a document as Markdown") {
  CHECK(write_markdown(without_details(document())) ==
        "# A title\n\n"
        "## Numbers\n\n"
        "| name | group: a [N m] | group: rsd |\n"
        "| --- | ---: | ---: |\n"
        "| low | 1.5 | 12 |\n"
        "| higher\\| | - | 3.25 |\n\n"
        "[1] a note\n\n"
        "a paragraph\n\nanother\n\n"
        "## Choices\n\n"
        "- cut-off = 10 Hz (quasi-static)\n"
        "- low, high: order = 2\n\n"
        "## Warnings\n\n"
        "- look\\\\x1b here\n");
}

TEST_CASE("the writer goes by the extension") {
  for (const ReportWriter& writer : report_writers()) {
    if (writer.write == write_html && !page_parts::built_in()) continue;
    CHECK(report_writer_for("a/b" + std::string(writer.extension)).name == writer.name);
  }
  CHECK(message_of([] { (void)report_writer_for("a.xlsx"); }).find("no report format '.xlsx'") ==
        0);
}

}  // namespace
