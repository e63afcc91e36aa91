// Tables 1 and 2 of Fichera & Grossard 2017, with their own numbers: rows, columns and order as
// printed, with one more column for the range that K depends on.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdio>

#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/report/writers/text_table.hpp"
#include "cablefit/report/writers/wrap.hpp"
#include "tests/report/results.hpp"

namespace {

using namespace cablefit;
using Row = std::vector<std::string>;

ElasticFit line_of(double k) {
  ElasticFit fit;
  fit.model = "linear";
  fit.parameters = {test::estimate("K", "N m/rad", k, 0.1)};
  fit.covariance = Eigen::MatrixXd::Constant(1, 1, 0.01);
  return fit;
}

ElasticFit cables_of(const std::vector<double>& k) {
  ElasticFit fit;
  fit.model = "poly";
  fit.order = 2;
  fit.transmission = antagonist_pair(2);
  const char* names[] = {"K1_0", "K1_1", "K2_0", "K2_1"};
  for (std::size_t i = 0; i < 4; ++i)
    fit.parameters.push_back(
        test::estimate(names[i], i % 2 == 0 ? "N m/rad" : "N m/rad^2", k[i], 0.1));
  fit.covariance = Eigen::MatrixXd::Identity(4, 4) / 100;
  return fit;
}

ElasticPreload row_of(const std::string& name, double k, const std::vector<double>& cables) {
  ElasticPreload preload;
  preload.name = name;
  preload.fits = {line_of(k), cables_of(cables)};
  return preload;
}

TEST_CASE("Table 1 has the paper's rows and columns", "[report]") {
  ElasticResult result;
  result.preloads = {row_of("Low", 1819.2, {1367.7, 37844.1, 1575.3, 29357.2}),
                     row_of("High", 3605.2, {-3894.7, 3891.4, 11171.0, 3094.9})};
  const std::vector<Table> tables = stiffness_tables(result);
  REQUIRE(tables.size() == 1);
  const Table& table = tables[0];
  Row titles;
  for (const Column& column : table.columns) titles.push_back(column.title);
  CHECK(titles == Row{"preload", "K", "deflection", "K1_0", "K1_1", "K2_0", "K2_1"});
  CHECK(table.columns[1].group == "Linear");
  CHECK(table.columns[3].group == "Polynomial");
  const auto printed = [](Row row) {
    row.erase(row.begin() + 2);
    return row;
  };
  // One digit more than printed where the sd of 0.1 supports it.
  CHECK(printed(table.rows[0]) ==
        Row{"Low", "1819.20", "1367.70", "37844.10", "1575.30", "29357.20"});
  CHECK(printed(table.rows[2]) ==
        Row{"High", "3605.20", "-3894.70", "3891.40", "11171.00", "3094.90"});
}

struct Printed {
  const char* name;
  const char* symbol;
  const char* unit;
  double cad;
  double value[4], rsd[4];  ///< low linear, low polynomial, high linear, high polynomial
};

// f_s and f_sm in N m: the print has N m s/rad for them (they are torques).
const double kNone = std::numeric_limits<double>::quiet_NaN();
const Printed kTable2[] = {
    {"J_link", "J_M", "kg m^2", 0.3, {0.408, 0.339, 0.345, 0.328}, {9.1, 4.3, 5.2, 4.0}},
    {"J_motor", "J_m", "kg m^2", 0.0019, {0.0228, 0.0133, 0.016, 0.014}, {8.2, 3.7, 3.6, 3.2}},
    {"f_v", "f_v", "N m s/rad", kNone, {3.854, 5.601, 8.204, 9.817}, {8.7, 7.5, 5.4, 5.2}},
    {"f_s", "f_s", "N m", kNone, {2.378, 3.274, 6.627, 7.034}, {7.3, 6.5, 4.4, 4.3}},
    {"f_vm", "f_vm", "N m s/rad", kNone, {0.894, 1.0654, 0.894, 0.997}, {8.9, 7.3, 5.6, 5.0}},
    {"f_sm", "f_sm", "N m", kNone, {1.087, 2.778, 4.510, 3.591}, {9.2, 5.1, 3.8, 3.2}},
    {"offset", "offset", "N m", kNone, {0.0431, 0.0286, 0.0231, 0.0186}, {3.2, 2.1, 2.2, 2.1}}};

/// As stage 2 has them: the link's equation, then the motor's.
DynamicFit fit_of(std::size_t column) {
  DynamicFit fit;
  fit.model = column % 2 == 0 ? "linear" : "poly";
  for (const std::size_t row : {0, 2, 3, 1, 4, 5, 6}) {
    const Printed& p = kTable2[row];
    Estimate e =
        test::estimate(p.name, p.unit, p.value[column], p.value[column] * p.rsd[column] / 100);
    e.symbol = p.symbol;
    e.cad = p.cad;
    fit.parameters.push_back(e);
  }
  return fit;
}

TEST_CASE("Table 2 has the paper's rows, columns and order", "[report]") {
  DynamicResult result;
  for (const std::size_t first : {0, 2}) {
    DynamicPreload& preload = result.preloads.emplace_back();
    preload.name = first == 0 ? "Low" : "High";
    preload.fits = {fit_of(first), fit_of(first + 1)};
  }
  const std::vector<Table> tables = parameter_tables(result);
  REQUIRE(tables.size() == 1);  // both preloads side by side
  const Table& table = tables[0];
  CHECK(text_table_width(table) <= kTextWidth);
  REQUIRE(table.rows.size() == std::size(kTable2));
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const Printed& p = kTable2[r];
    const Row& row = table.rows[r];
    INFO(row[0]);
    CHECK(row[0].substr(0, row[0].find(' ')) == p.name);
    CHECK(row[2] == (std::isnan(p.cad) ? "-" : fmt::format("{:g}", p.cad)));
    for (std::size_t c = 0; c < 4; ++c) {
      // Printed to the sd's second digit: half of that off at most.
      CHECK(std::abs(std::stod(row[3 + 2 * c]) - p.value[c]) <= 0.05 * p.value[c] * p.rsd[c] / 100);
      CHECK(std::abs(std::stod(row[4 + 2 * c]) - p.rsd[c]) < 0.051);
    }
  }
  std::printf("%s\n", text_table(table).c_str());
}

TEST_CASE("what the paper does not have stands below its rows", "[report]") {
  DynamicResult result;
  result.preloads.resize(1);
  DynamicFit fit = fit_of(1);
  fit.parameters.insert(fit.parameters.begin() + 3, test::estimate("drag", "N m", 1, 0.1));
  result.preloads[0].fits = {fit};
  const Table table = parameter_tables(result).front();
  CHECK(table.rows[1][0] == "J_motor (J_m)");
  CHECK(table.rows.back()[0] == "drag");
}

}  // namespace
