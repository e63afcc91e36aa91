// The page as text; what a browser makes of it is tested in tests/page.
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "cablefit/report/page/html_text.hpp"
#include "cablefit/report/page/page_body.hpp"
#include "cablefit/report/page/page_data.hpp"
#include "cablefit/report/page/page_parts.hpp"
#include "cablefit/report/page/svg_figure.hpp"
#include "cablefit/report/page/trace_look.hpp"
#include "cablefit/report/parts/figure_units.hpp"
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
                                    "\" onmouseover=\"alert(1)",
                                    "' onmouseover='alert(1)",
                                    "\xFF\x1b[31m\"'\\"};

Document hostile(const std::string& text) {
  Document d;
  d.title = text;
  d.tables = {{text, {{text, text, text, true}}, {{text}}, {text}},
              {text, {{text, text, text, true, true}}, {{text}}, {text}, true}};
  d.headline = {text, Tone::bad, text, {{text, text}}};
  d.origin = {text, text};
  d.paragraphs = d.warnings = {text};
  d.summary = {{text, text}};
  d.decisions = {{{text}, text, text, text}};
  Figure figure;
  figure.section = figure.group = figure.title = figure.caption = text;
  figure.x = figure.y = {text, text};
  figure.marks = {{1, text}};
  figure.traces = {{text, TraceStyle::interval, 1, {}, {1}, {0}, {2}, {text}}};
  d.figures = {figure, figure, figure};
  d.figures[0].rank = FigureRank::main;
  d.figures[2].rank = FigureRank::detail;
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

std::size_t count(std::string_view text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what, at + 1))
    ++n;
  return n;
}

TEST_CASE("nothing from a log becomes an element or an attribute of the page") {
  const std::string harmless = page_body(hostile("x"));
  for (const std::string text : kHostile) {
    const std::string body = page_body(hostile(text));
    INFO(text);
    for (const char* bad :
         {"<script", "<img", "<!--", "</script", "\" onmouseover", "' onmouseover"})
      CHECK(body.find(bad) == std::string::npos);
    // Of every text each < > and quote is escaped: the page has as many as with an "x".
    for (const char* c : {"<", ">", "\"", "'"}) CHECK(count(body, c) == count(harmless, c));
  }
}

TEST_CASE("a name from a log does not turn the direction of the text beside it") {
  const std::string name = "\u05E9\u05DC", alone = "\u2068" + name + "\u2069";
  CHECK(html_text(name + ": 3.2 N m") == alone + ": 3.2 N m");
  CHECK(html_text("low\u202E.csv") == "low\\xe2\\x80\\xae.csv");
  const std::string body = page_body(hostile(name)), data = page_data(hostile(name));
  CHECK(count(body, name) > 10);
  CHECK(count(body, name) == count(body, alone));
  CHECK(count(data, "\"name\":\"" + alone + "\"") == 3);
}

TEST_CASE("the page reads without a script: its texts and tables are HTML") {
  const std::string body = page_body(hostile("a & b"));
  // Title, command and date; headline; summary; the figures; tables; the rest.
  CHECK(body.find("<h1>a &amp; b</h1>") != std::string::npos);
  CHECK(body.find("<code>a &amp; b</code>") != std::string::npos);
  CHECK(body.find("<span class=\"badge bad\">a &amp; b</span>") != std::string::npos);
  CHECK(body.find("<dt>a &amp; b</dt><dd>a &amp; b</dd>") != std::string::npos);
  CHECK(body.find("<td class=\"text\">a &amp; b</td>") != std::string::npos);
  CHECK(body.find("<small>[a &amp; b]</small>") != std::string::npos);
  CHECK(count(body, "<svg") == 1);  // of the main figure
  CHECK(body.find("<figcaption>a &amp; b</figcaption>") != std::string::npos);
}

TEST_CASE("what is no result is folded") {
  const std::string body = page_body(hostile("x"));
  const std::size_t fold = body.find("<details class=\"fold");
  REQUIRE(fold != std::string::npos);
  CHECK(body.find("data-figure=\"1\"") < fold);
  CHECK(body.find("data-figure=\"2\"") > fold);
  CHECK(count(body.substr(0, fold), "<table>") == 1);
  Document many = hostile("x");
  many.figures.assign(50, many.figures[1]);
  const std::string crowded = page_body(many);
  CHECK(count(crowded.substr(0, crowded.find("<details class=\"fold")), "<figure") ==
        kMostShownFigures);
}

TEST_CASE("units and symbols look as in print") {
  CHECK(pretty_unit("kg m^2") == "kg m²");
  CHECK(pretty_unit("10^-12 ^") == "10^-12 ^");
  CHECK(pretty_symbols("tau_load, theta - q, taut, tau") == "τ_load, θ − q, taut, τ");
  CHECK(pretty_symbols("theta of run_theta.csv, tau.json: tau") ==
        "θ of run_theta.csv, tau.json: τ");
  CHECK(pretty_cell("1.0 +- 0.1 -> 2") == "1.0 ± 0.1 → 2");
}

TEST_CASE("deflections and gaps have the units of the tables, other positions their own") {
  Figure figure;
  figure.x = {"deflection theta - q", "rad"};
  figure.y = {"gap of q", "m"};
  figure.traces = {{"", TraceStyle::interval, 1, {0.001}, {0.002}, {0.001}, {0.003}, {}}};
  figure.marks = {{0.004, ""}};
  const Figure shown = in_table_units(figure);
  CHECK(shown.x.unit == "mrad");
  CHECK(shown.y.unit == "mm");
  CHECK(shown.traces[0].x[0] == Approx(1));
  CHECK(shown.traces[0].y[0] == Approx(2));
  CHECK(shown.traces[0].high[0] == Approx(3));
  CHECK(shown.marks[0].x == Approx(4));
  figure.x = {"position q", "rad"};
  CHECK(in_table_units(figure).x.unit == "rad");
}

TEST_CASE("series differ by more than their colour") {
  Figure figure;
  for (int series = 1; series < 4; ++series) {
    figure.traces.push_back({"", TraceStyle::line, series, {}, {}, {}, {}, {}});
    figure.traces.back().x = figure.traces.back().y = std::vector<double>(100, 1);
  }
  std::set<std::string> dashes, symbols;
  for (std::size_t k = 0; k < figure.traces.size(); ++k) {
    dashes.insert(look_of(figure, k).dash);
    symbols.insert(look_of(figure, k).symbol);
    CHECK(look_of(figure, k).n_symbols > 0);
  }
  CHECK(dashes.size() == 3);
  CHECK(symbols.size() == 3);
}

TEST_CASE("a figure as SVG: every trace, round ticks, nothing that is no number") {
  Figure figure;
  figure.title = "a < b";
  figure.x = {"time", "s"};
  figure.y = {"torque tau", "N m"};
  for (const TraceStyle style :
       {TraceStyle::line, TraceStyle::broad, TraceStyle::dashed, TraceStyle::points,
        TraceStyle::steps, TraceStyle::interval, TraceStyle::area}) {
    Trace trace{"t", style, 1, {0, 5, 7, 10}, {1, std::nan(""), 2, 3}, {}, {}, {}};
    if (style == TraceStyle::interval) trace.low = trace.high = trace.y;
    figure.traces.push_back(trace);
  }
  const std::string svg = svg_figure(figure);
  INFO(svg);
  CHECK(svg.starts_with("<svg "));
  CHECK(svg.find("<title>a &lt; b</title>") != std::string::npos);
  CHECK(count(svg, ">t</text>") == 7);
  CHECK(svg.find(">10</text>") != std::string::npos);
  CHECK(svg.find("torque τ [N m]") != std::string::npos);
  CHECK(svg.find("nan") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);
  // A phone shows it about 340 px wide: texts are then 10 px high or more.
  CHECK(svg.find("viewBox=\"0 0 400 300\"") != std::string::npos);
  CHECK(svg.find("font:12px") != std::string::npos);
  figure.traces.clear();  // nothing to draw is no reason to fail
  CHECK(svg_figure(figure).find("nan") == std::string::npos);
}

TEST_CASE("a logarithmic axis has powers of ten where a linear one has even steps") {
  Figure figure;
  figure.y = {"error", "N m", true};
  figure.traces = {{"", TraceStyle::line, 1, {0, 1, 2, 3}, {0.06, 1, 41, 0}, {}, {}, {}}};
  const std::string svg = svg_figure(figure);
  INFO(svg);
  for (const char* tick : {">0.1</text>", ">1</text>", ">10</text>"})
    CHECK(svg.find(tick) != std::string::npos);
  CHECK(svg.find(">20</text>") == std::string::npos);
  CHECK(svg.find("inf") == std::string::npos);  // 0 has no place
  figure.traces.front().y = {1, 2, 3, 4};
  CHECK(svg_figure(figure).find(">2</text>") != std::string::npos);
  Document document;
  document.figures = {figure};
  const auto data = nlohmann::json::parse(page_data(document));
  CHECK(data["figures"][0]["y"]["log"] == true);
  CHECK(data["figures"][0]["x"]["log"] == false);
}

TEST_CASE("a plot of values that differ by rounding alone, far from 0, or with many names") {
  Figure figure;
  figure.traces = {
      {"q", TraceStyle::line, 0, {0, 1, 2}, {0.1, std::nextafter(0.1, 1), 0.1}, {}, {}, {}}};
  CHECK(count(svg_figure(figure), "</text>") < 30);  // it used to make ticks without end
  figure.traces.front().y = {123456.1, 123456.9, 123456.5};
  CHECK(svg_figure(figure).find(">123456.4</text>") != std::string::npos);
  const Trace one{std::string(50, 'x'), TraceStyle::line, 0, {0, 1}, {0, 1}, {}, {}, {}};
  figure.traces.assign(40, one);
  const std::string svg = svg_figure(figure);
  CHECK(svg.find(">+ 35 more</text>") != std::string::npos);
  CHECK(count(svg, one.name) == 5);
}

TEST_CASE("the JSON of the page says what the figures say") {
  const auto data = nlohmann::json::parse(page_data(hostile("<b>&\"")));
  CHECK(data["figures"][0]["title"] == "<b>&\"");
  CHECK(data["figures"][0]["y"]["unit"] == "<b>&\"");
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
