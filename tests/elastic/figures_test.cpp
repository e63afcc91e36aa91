// What is drawn is what was fitted, and costs nothing unless it is asked for.
#include <algorithm>
#include <cmath>

#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/elastic/figures/basis_figures.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

ElasticPreload fitted(bool figures, int threads) {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv")};
  ElasticOptions options;
  options.figures = figures;
  options.samples.threads = threads;
  return fit_elastic(logs, options).preloads.at(0);
}

const Figure& figure(const ElasticPreload& preload, const std::string& title) {
  for (const Figure& one : preload.figures)
    if (one.title == title) return one;
  FAIL("no figure " << title);
  return preload.figures.front();
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    if (!std::isnan(value)) most = std::max(most, std::abs(value));
  return most;
}

TEST_CASE("figures of stage 1 show the residuals of the fit") {
  const ElasticPreload low = fitted(true, 2);
  const Figure& error = figure(low, "Torque error over time");
  REQUIRE(error.traces.size() == 2);
  for (std::size_t k = 0; k < 2; ++k)
    CHECK_THAT(largest(error.traces[k].y), Catch::WithinRel(low.fits[k].max_abs_error, 1e-9));
  const Figure& curve = figure(low, "Torque against deflection");
  REQUIRE(curve.traces.size() == 4);
  CHECK_THAT(curve.traces[3].x.front(), Catch::WithinAbs(low.deflection_low, 1e-3));
  CHECK_THAT(curve.traces[3].x.back(), Catch::WithinAbs(low.deflection_high, 1e-3));
  for (const Figure& one : low.figures) {
    INFO(one.title);
    CHECK(one.section == "low");
    CHECK(!one.traces.empty());
    for (const Trace& trace : one.traces) {
      CHECK(!trace.x.empty());
      CHECK(trace.x.size() == trace.y.size());
    }
  }
}

TEST_CASE("the first figure of stage 1 is the error of each model, with its size") {
  const ElasticPreload low = fitted(true, 1);
  const auto first = std::find_if(low.figures.begin(), low.figures.end(),
                                  [](const Figure& one) { return one.rank == FigureRank::main; });
  REQUIRE(first != low.figures.end());
  CHECK(first->title == "Elastic error against deflection");
  REQUIRE(first->traces.size() == low.fits.size());
  for (std::size_t k = 0; k < low.fits.size(); ++k) {
    const Trace& error = first->traces[k];
    CHECK_THAT(largest(error.y), Catch::WithinRel(low.fits[k].max_abs_error, 1e-9));
    CHECK(error.name.ends_with(fmt::format(", rms {:.3g} N m", low.fits[k].rms_error)));
  }
}

TEST_CASE("errors of bases, from tenths to tens of N m, are drawn on a logarithmic axis") {
  ElasticPreload preload;
  BasisScore score;
  score.basis = "polynomial";
  score.path = {41, 3, 0.06};
  preload.bases.emplace().scores = {score};
  const std::vector<Figure> figures = basis_figures(preload);
  REQUIRE(figures.size() == 2);
  CHECK_FALSE(figures[0].y.logarithmic);  // of the stiffness
  CHECK(figures[1].y.logarithmic);
  CHECK(figures[1].traces.front().y == score.path);
}

TEST_CASE("the fitted line of the figure is the linear model") {
  const ElasticPreload low = fitted(true, 1);
  const ElasticFit& linear = low.fits.at(0);
  const Trace& line = figure(low, "Torque against deflection").traces.at(2);
  for (std::size_t i = 0; i < line.x.size(); ++i)
    CHECK_THAT(line.y[i],
               Catch::WithinAbs(linear.parameters[0].value * line.x[i] + linear.offset, 1e-6));
}

TEST_CASE("stage 1 draws the models of Fig. 4 and a map of the modes") {
  const ElasticPreload low = fitted(true, 1);
  const Figure& cables = figure(low, "Elastic torque of each cable");
  const Trace& classical = cables.traces.at(cables.traces.size() - 2);
  CHECK(classical.name == "classical linear, K (theta - q)");
  CHECK_THAT(classical.y.back(),
             Catch::WithinRel(low.fits[0].parameters[0].value * classical.x.back(), 1e-9));
  const Trace& first_order = cables.traces.back();
  CHECK(first_order.name == "cables of order 1");
  // One slope on each side of zero, and not the line's.
  CHECK_THAT(first_order.y.at(150) / first_order.x.at(150),
             Catch::WithinRel(first_order.y.back() / first_order.x.back(), 1e-6));
  CHECK(std::abs(first_order.y.back() / classical.y.back() - 1) > 1e-3);
  const Figure& map = figure(low, "Force closure and disclosure over q and theta");
  const Trace& rows = map.traces.back();
  CHECK(rows.name == "rows of the logs");
  // The cloud spans what was fitted, less what two of its at least 16 cells may hide.
  const auto [least, most] = std::minmax_element(rows.y.begin(), rows.y.end());
  CHECK_THAT(*most - *least, Catch::WithinAbs(low.deflection_high - low.deflection_low, 0.012));
  CHECK(largest(rows.x) < 1e-4);  // the link is blocked at 0
  CHECK(map.notes.size() == 2);   // no preload: one cable or the other
}

TEST_CASE("figures of stage 1 do not depend on the threads, and the fit not on figures") {
  const ElasticPreload one = fitted(true, 1), many = fitted(true, 5), none = fitted(false, 1);
  CHECK(none.figures.empty());
  CHECK(none.fits[1].parameters[0].value == one.fits[1].parameters[0].value);
  CHECK(none.fits[1].parameters[0].sd == one.fits[1].parameters[0].sd);
  REQUIRE(one.figures.size() == many.figures.size());
  for (std::size_t k = 0; k < one.figures.size(); ++k)
    for (std::size_t j = 0; j < one.figures[k].traces.size(); ++j) {
      const Trace &a = one.figures[k].traces[j], &b = many.figures[k].traces[j];
      CHECK(a.x == b.x);
      CHECK(std::equal(a.y.begin(), a.y.end(), b.y.begin(), b.y.end(), [](double u, double v) {
        return u == v || (std::isnan(u) && std::isnan(v));
      }));
    }
}

}  // namespace
