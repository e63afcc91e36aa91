// The page as text; what a browser makes of it is tested in tests/page.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cablefit/report/page/page_data.hpp"
#include "cablefit/report/page/page_parts.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using test::message_of;

constexpr const char* kHostile[] = {"<script>alert(1)</script>",
                                    "</script><img src=x onerror=alert(1)>",
                                    "<!--<script>",
                                    "]]>&amp;",
                                    "\xE2\x80\xA8\xE2\x80\xA9",
                                    "{{data}}{{script}}",
                                    "\xFF\x1b[31m\"'\\"};

Document hostile(const std::string& text) {
  Document d;
  d.title = text;
  d.tables = {{text, {{text, text, text, true}}, {{text}}, {text}}};
  d.paragraphs = d.warnings = {text};
  d.summary = {{text, text}};
  d.decisions = {{{text}, text, text, text}};
  Figure figure;
  figure.section = figure.group = figure.title = figure.caption = text;
  figure.x = figure.y = {text, text};
  figure.marks = {{1, text}};
  figure.traces = {{text, TraceStyle::interval, 1, {}, {1}, {0}, {2}, {text}}};
  d.figures = {figure};
  return d;
}

TEST_CASE("nothing from a log can leave the JSON of the page") {
  for (const std::string text : kHostile) {
    const std::string data = page_data(hostile(text));
    INFO(data);
    CHECK(data.find_first_of("<>&") == std::string::npos);
    CHECK(data.find("\xE2\x80\xA8") == std::string::npos);
    CHECK(data.find("\xE2\x80\xA9") == std::string::npos);
    CHECK(nlohmann::json::accept(data));
  }
}

TEST_CASE("the JSON of the page says what the document says") {
  const auto data = nlohmann::json::parse(page_data(hostile("<b>&\"")));
  CHECK(data["title"] == "<b>&\"");
  CHECK(data["tables"][0]["columns"][0]["unit"] == "<b>&\"");
  CHECK(data["tables"][0]["rows"][0][0] == "<b>&\"");
  CHECK(data["summary"][0]["label"] == "<b>&\"");
  CHECK(data["summary"][0]["text"] == "<b>&\"");
  CHECK(data["decisions"][0]["reason"] == "<b>&\"");
  CHECK(data["figures"][0]["traces"][0]["style"] == "interval");
  CHECK(data["figures"][0]["traces"][0]["labels"][0] == "<b>&\"");
}

TEST_CASE("numbers are packed as little-endian floats in base64") {
  CHECK(packed({1.0}, 0) == "AACAPw==");           // 0x3F800000
  CHECK(packed({1e9 + 0.5}, 1e9) == "AAAAPw==");   // 0x3F000000: nothing lost beside a base
  CHECK(packed({std::nan("")}, 0) == "AADAfw==");  // quiet NaN, 0x7FC00000
}

TEST_CASE("a page is whole") {
  if (!page_parts::built_in()) {
    WARN("built without the HTML page");
    return;
  }
  const std::string page = write_html(hostile("{{plotly}}{{script}}</body>"));
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK(page.ends_with("</html>\n"));
  CHECK(page.find("plotly.js (basic - minified)") != std::string::npos);
  CHECK(page.find("Licensed under the MIT license") != std::string::npos);
  CHECK(page.find("script-src 'sha256-") != std::string::npos);
  // The parts must not end their elements themselves.
  for (const std::string_view part : {page_parts::plotly(), page_parts::script()}) {
    CHECK(part.find("</script") == std::string_view::npos);
    CHECK(part.find("<!--") == std::string_view::npos);
  }
  CHECK(page_parts::style().find("</style") == std::string_view::npos);
}

TEST_CASE("single plots are not written") {
  CHECK(message_of([] { (void)report_writer_for("plot.svg"); }) ==
        "plots are not written as single files; use --report FILE.html: each plot of the page has "
        "a button that saves it as SVG");
}

}  // namespace
