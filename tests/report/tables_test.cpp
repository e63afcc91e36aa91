// Table 1 and Table 2, laid out from results made by hand.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "cablefit/report/documents/batch_document.hpp"
#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/writers/bases_csv.hpp"
#include "cablefit/report/writers/text_table.hpp"
#include "cablefit/report/writers/wrap.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/report/results.hpp"
#include "tests/report/schema.hpp"

namespace {

using namespace cablefit;
using Catch::Matchers::Contains;
using Row = std::vector<std::string>;

TEST_CASE("Table 1 has preloads as rows and dashes where a cable is of lower order") {
  CHECK(text_table(stiffness_tables(test::elastic_result()).front()) ==
        "Stiffness (Table 1)\n"
        "\n"
        "                  Linear                             Polynomial\n"
        "preload          K     deflection       K1_0         K1_1       K2_0         K2_1\n"
        "         [N m/rad]         [mrad]  [N m/rad]  [N m/rad^2]  [N m/rad]  [N m/rad^2]\n"
        "---------------------------------------------------------------------------------\n"
        "low           1819  -44.5 .. 33.3     1368.0      37894.5     1368.0      37894.5\n"
        "             +- 40                    +- 1.1       +- 1.1     +- 1.1       +- 1.1\n"
        "high          1819  -44.5 .. 33.3     1368.0      37894.5     1368.0            -\n"
        "             +- 40                    +- 1.1       +- 1.1     +- 1.1\n");
}

// The paper's columns stay, whatever the orders.
TEST_CASE("coefficients beyond the paper's have rows below Table 1") {
  ElasticResult result;
  result.preloads = {test::elastic_preload("low", 2, 2), test::elastic_preload("high", 5, 4)};
  const std::vector<Table> tables = stiffness_tables(result);
  REQUIRE(tables.size() == 2);
  for (const Table& table : tables) CHECK(text_table_width(table) <= kTextWidth);
  CHECK(text_table(tables[0]).substr(0, 320) ==
        text_table(stiffness_tables(test::elastic_result()).front()).substr(0, 320));
  CHECK(tables[1].title == "Stiffness: further coefficients");
  REQUIRE(tables[1].rows.size() == 1 + 3 + 2);
  CHECK(tables[1].rows[3][0] == "K1_4");
  CHECK(tables[1].rows[3][2] == "-");
  CHECK(tables[1].rows[3][4] != "-");
  CHECK(tables[1].rows[4][0] == "K2_2");
}

TEST_CASE("further coefficients of many preloads are cut into tables of readable width") {
  ElasticResult result;
  for (int k = 0; k < 20; ++k)
    result.preloads.push_back(test::elastic_preload("preload " + std::to_string(k), 5, 4));
  const std::vector<Table> tables = stiffness_tables(result);
  REQUIRE(tables.size() > 3);
  CHECK(tables[0].rows.size() == 2 * 20);
  std::string seen;
  for (std::size_t t = 1; t < tables.size(); ++t) {
    const Table& table = tables[t];
    CHECK(text_table_width(table) <= kTextWidth);
    CHECK(table.rows.size() == tables[1].rows.size());
    for (std::size_t k = 2; k < table.columns.size(); k += 2) seen += table.columns[k].group + ";";
  }
  std::string expected;
  for (int k = 0; k < 20; ++k) expected += "preload " + std::to_string(k) + ";";
  CHECK(seen == expected);
}

TEST_CASE("Table 2 marks what is not identifiable and what stands at a bound") {
  const std::vector<Table> tables = parameter_tables(test::dynamic_result());
  REQUIRE(tables.size() == 1);
  const Table& table = tables.front();
  CHECK(text_table_width(table) <= kTextWidth);
  REQUIRE(table.rows.size() == 3);
  CHECK(Row(table.rows[0].begin(), table.rows[0].begin() + 5) ==
        Row{"J_link (J_M)", "kg m^2", "0.3", "0.339", "4.3"});
  CHECK(Row(table.rows[1].begin() + 5, table.rows[1].begin() + 7) == Row{"-", "[1]"});
  CHECK(Row(table.rows[2].begin() + 5, table.rows[2].begin() + 7) == Row{"0", "[2]"});
  REQUIRE(table.notes.size() == 3);
  CHECK(table.notes[0] == "[1] not identifiable: is not separable from f_s in these logs");
  CHECK(table.notes[1] == "[2] at its bound f_s >= 0: 95 % interval up to 0.12 N m");
  CHECK_THAT(table.notes[2], Contains("4.0 to 4.0 times that of the paper's (25)"));
}

TEST_CASE("Table 2 is cut into tables of readable width") {
  DynamicResult result;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    result.preloads.push_back(test::dynamic_preload(name));
  }
  const std::vector<Table> tables = parameter_tables(result);
  CHECK(tables.size() > 1);
  for (const Table& table : tables) CHECK(text_table_width(table) <= kTextWidth);
}

TEST_CASE("a load's own inertia is part of J_link, and told") {
  DynamicResult result;
  result.preloads = {test::dynamic_preload("low")};
  result.preloads[0].load_inertia = 0.3;
  const Table table = parameter_tables(result).front();
  CHECK(Row(table.rows[1].begin(), table.rows[1].begin() + 5) ==
        Row{"  without the load", "kg m^2", "-", "0.039", "37"});
}

TEST_CASE("a headline names the preloads whose inertia is not determined") {
  DynamicResult result = test::dynamic_result();
  result.preloads = {test::dynamic_preload("low"), test::dynamic_preload("high")};
  const auto inertia = [&result] {
    for (const SummaryLine& number : dynamic_document(result).headline.numbers)
      if (number.label == "J_link") return number.text;
    return std::string();
  };
  CHECK(inertia().ends_with(" kg m^2"));
  for (DynamicFit& fit : result.preloads.back().fits)
    for (Estimate& e : fit.parameters)
      if (e.name == "J_link") e.not_identifiable = "too slow";
  CHECK(inertia().ends_with(" kg m^2, not determined: high"));
}

TEST_CASE("a campaign of one cell is told in the singular") {
  BatchResult result;
  result.cells.resize(1);
  CHECK(batch_document(result).headline.verdict == "1 cell fitted");
  result.cells.resize(2);
  CHECK(batch_document(result).headline.verdict == "all 2 cells fitted");
}

TEST_CASE("a linear axis has forces and masses") {
  ElasticResult result;
  result.preloads = {test::elastic_preload("low", 2, 2)};
  result.preloads[0].axes = Axes::linear;
  result.preloads[0].unit = "m";
  const std::string text = write_text(elastic_document(result));
  CHECK_THAT(text, Contains("[mm]") && Contains("[N]") && !Contains("[mrad]"));
}

// Fig. 6b as numbers.
TEST_CASE("scores of straight lines have a table and are valid JSON") {
  ElasticResult result = test::elastic_result();
  result.preloads[0].scores = {{"linear", "given", 1819.2, false, 24.9, 71.96, 0.05},
                               {"poly, order 2", "all samples",
                                std::numeric_limits<double>::quiet_NaN(), true, 0.05, 0.2, -0.01}};
  CHECK(test::schema_errors("elastic", elastic_json(result)) == "");
  const std::string text = write_text(elastic_document(result));
  for (const char* line :
       {"Errors of the elastic torque (Figs. 6b, 7b)",
        "linear         given           1819.2  these logs    24.9   72.0    50.0",
        "poly, order 2  all samples          -  test logs   0.0500  0.200   -10.0"}) {
    INFO(text);
    CHECK(text.find(line) != std::string::npos);
  }
}

TEST_CASE("bases of the cable force have a table, valid JSON and a CSV file") {
  ElasticResult result = test::elastic_result();
  BasisScore polynomial, spline;
  polynomial.basis = "polynomial";
  polynomial.n_terms = 2;
  polynomial.cable_terms = {1, 1};
  polynomial.path = {9, 4.5, 2.25};
  polynomial.held_out_rms = 4.5;
  polynomial.rms_error = 4.4;
  polynomial.lowest_secant = -12.3;
  polynomial.pulls = false;
  polynomial.terms = {{"1", "l", 1800}, {"2", "l", 1700}};
  polynomial.curve = {{-0.01, 0.01}, {-17, 18}, {1700, 1800}};
  spline = polynomial;
  spline.basis = "I-spline";
  spline.n_terms = 3;
  spline.cable_terms = {2, 1};
  spline.path = {8, 2, 0.5};
  spline.held_out_rms = 0.5;
  spline.lowest_secant = 1600;
  spline.pulls = true;
  result.preloads[0].bases = BasisComparison{{polynomial, spline}, 0.061, 20, 5};
  CHECK(test::schema_errors("elastic", elastic_json(result)) == "");
  const std::string text = write_text(elastic_document(result));
  INFO(text);
  for (const char* line : {"Bases of the cable force", "scatter about short lines 0.0610 N m rms"})
    CHECK(text.find(line) != std::string::npos);
  // Of three terms the polynomial has 2.25 N m, of two its own.
  for (const char* row : {"polynomial  1 + 1", "I-spline    2 + 1"}) {
    const std::size_t at = text.find(row);
    REQUIRE(at != std::string::npos);
    const std::string line = text.substr(at, text.find('\n', at) - at);
    const bool is_spline = line.starts_with("I-spline");
    CHECK_THAT(line, Contains(is_spline ? "2.25" : "4.50") && Contains(is_spline ? "yes" : "no"));
  }
  const std::string csv = bases_csv(result);
  CHECK(
      csv.starts_with("preload,deflection [rad],polynomial torque [N m],polynomial stiffness "
                      "[N m/rad],I-spline torque [N m],I-spline stiffness [N m/rad]\n"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
  CHECK(std::isnan(result.preloads[0].bases->polynomial_rms(4)));
}

TEST_CASE("estimates updated row by row stand beside the direct answer") {
  DynamicResult result = test::dynamic_result();
  DynamicFit& fit = result.preloads[0].fits[0];
  RecursiveTrace trace;
  trace.rule = {"recursive", 0.995, 2, 0, 0};
  TracePoint end{100, "a.csv", {}, {}, 2};
  for (const Estimate& e : fit.parameters) {
    trace.names.push_back(e.name);
    trace.preloads.push_back("low");
    trace.units.push_back(e.unit);
    end.value.push_back(e.value * 1.5);
    end.sd.push_back(e.value * 0.25);
  }
  trace.points = {end};
  fit.traces = {trace};
  CHECK(test::schema_errors("dynamic", dynamic_json(result)) == "");
  const std::string text = write_text(dynamic_document(result));
  INFO(text);
  CHECK_THAT(text, Contains("Estimates updated row by row, at the end of the logs") &&
                       Contains("recursive, memory 2.00") && Contains("2.0"));
}

TEST_CASE("decisions that all preloads share stand once") {
  const Document document = elastic_document(test::elastic_result());
  REQUIRE(document.decisions.size() == 3);
  CHECK(where_text(document.decisions[0]) == "");
  CHECK(document.decisions[0].name == "cut-off");
  CHECK(where_text(document.decisions[1]) == "low: ");
  CHECK(where_text(document.decisions[2]) == "high: ");
}

TEST_CASE("the tidy table has a row per preload, model and parameter") {
  const Document document = dynamic_document(test::dynamic_result());
  std::size_t n_parameters = 0;
  for (const Row& row : document.tidy.rows) {
    CHECK(row.size() == document.tidy.columns.size());
    n_parameters += row[3].rfind("torque_error", 0) == 0 ? 0 : 1;
  }
  CHECK(n_parameters == 2 * 2 * 3);
  // Not identifiable: a value, but nothing that could pass for its uncertainty.
  const Row& f_v = document.tidy.rows[3 + 6 + 1];
  CHECK(Row(f_v.begin() + 3, f_v.begin() + 12) ==
        Row{"f_v", "f_v", "N m s/rad", "5.601", "", "", "", "", ""});
}

}  // namespace
