// Fig. 4 of the paper from a model: two linear cables with preload, stiff while both are taut.
#include "cablefit/elastic/figures/cable_figure.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

TEST_CASE("a preloaded pair of linear cables bends where one goes slack", "[elastic]") {
  Transmission pair = antagonist_pair(1);
  pair.cables[0].coefficients = {1000};
  pair.cables[1].coefficients = {1500};
  pair.cables[0].initial_elongation = 0.006;  // K1 l_o1 = K2 l_o2: in equilibrium
  pair.cables[1].initial_elongation = 0.004;
  const Figure figure = cable_figure(pair, -0.02, 0.02, Axes::rotary);
  REQUIRE(figure.traces.size() == 4);
  const Trace &box = figure.traces[0], &all = figure.traces[1], &first = figure.traces[2],
              &second = figure.traces[3];
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    const double phi = all.x[i];
    const double expected =
        (phi > -0.006 ? 1000 * (phi + 0.006) : 0) - (phi < 0.004 ? 1500 * (0.004 - phi) : 0);
    CHECK_THAT(all.y[i], Catch::WithinAbs(expected, 1e-12));
    CHECK_THAT(first.y[i] + second.y[i], Catch::WithinAbs(expected, 1e-12));
    CHECK(first.y[i] >= 0);  // a cable only pulls
    CHECK(second.y[i] <= 0);
  }
  REQUIRE(figure.marks.size() == 2);
  CHECK_THAT(figure.marks[0].x, Catch::WithinAbs(-0.006, 1e-12));
  CHECK(figure.marks[0].text == "1");
  CHECK_THAT(figure.marks[1].x, Catch::WithinAbs(0.004, 1e-12));
  CHECK(figure.marks[1].text == "2");

  // Fig. 3d: closure up to the torque at which one cable alone holds, K l_o1 + K l_o2.
  CHECK(box.style == TraceStyle::area);
  const std::vector<double> x = {-0.006, 0.004, 0.004, -0.006, -0.006};
  const std::vector<double> y = {-15, -15, 10, 10, -15};
  REQUIRE(box.x.size() == x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    CHECK_THAT(box.x[k], Catch::WithinAbs(x[k], 1e-12));
    CHECK_THAT(box.y[k], Catch::WithinAbs(y[k], 1e-9));
  }
  REQUIRE(figure.notes.size() == 3);
  CHECK(figure.notes[0].text == "slack: 1");
  CHECK_THAT(figure.notes[0].x, Catch::WithinAbs(-0.013, 1e-12));
  CHECK(figure.notes[0].y > 0);  // the curve is below
  CHECK(figure.notes[1].text == "all taut");
  CHECK(figure.notes[2].text == "slack: 2");
  CHECK(figure.notes[2].y < 0);

  pair.cables[0].initial_elongation = 0.0006;  // too close for two names
  pair.cables[1].initial_elongation = 0.0004;
  const std::vector<Mark> marks = cable_figure(pair, -0.02, 0.02, Axes::rotary).marks;
  REQUIRE(marks.size() == 2);
  CHECK(marks[0].text.empty());
  CHECK(marks[1].text == "1, 2");
}

TEST_CASE("without preload no deflection keeps both cables taut", "[elastic]") {
  Transmission pair = antagonist_pair(1);
  for (Cable& cable : pair.cables) cable.coefficients = {1000};
  const Figure figure = cable_figure(pair, -0.02, 0.03, Axes::rotary);
  REQUIRE(figure.traces.size() == 3);
  CHECK(figure.traces[0].name == "all cables");
  REQUIRE(figure.notes.size() == 2);
  CHECK(figure.notes[0].text == "slack: 1");
  CHECK(figure.notes[1].text == "slack: 2");
}

TEST_CASE("simpler models are drawn beside the cables", "[elastic]") {
  Transmission pair = antagonist_pair(2), line;
  for (Cable& cable : pair.cables) cable.coefficients = {1000, 2e4};
  line.linear_stiffness = Eigen::VectorXd::Constant(1, 1200);
  const std::vector<ComparedModel> compared = {{"line", line}};
  const Figure figure = cable_figure(pair, -0.02, 0.02, Axes::rotary, compared);
  REQUIRE(figure.traces.size() == 4);
  const Trace& drawn = figure.traces.back();
  CHECK(drawn.name == "line");
  CHECK(drawn.style == TraceStyle::dashed);
  CHECK(drawn.series == 3);  // no cable's
  for (std::size_t k = 0; k < drawn.x.size(); ++k)
    CHECK_THAT(drawn.y[k], Catch::WithinAbs(1200 * drawn.x[k], 1e-12));
}

// Of two linear cables: K1 + K2 while both are taut, else that of the one which holds.
TEST_CASE("the stiffness steps where a cable goes slack", "[elastic]") {
  Transmission pair = antagonist_pair(1), line;
  pair.cables[0].coefficients = {1000};
  pair.cables[1].coefficients = {1500};
  pair.cables[0].initial_elongation = 0.006;
  pair.cables[1].initial_elongation = 0.004;
  line.linear_stiffness = Eigen::VectorXd::Constant(1, 1200);
  const std::vector<ComparedModel> compared = {{"line", line}};
  const Figure figure = stiffness_figure(pair, -0.02, 0.02, Axes::rotary, compared);
  REQUIRE(figure.traces.size() == 3);
  const Trace &box = figure.traces[0], &all = figure.traces[1], &drawn = figure.traces[2];
  for (std::size_t i = 0; i < all.x.size(); ++i) {
    const double phi = all.x[i];
    CHECK(all.y[i] == (phi < -0.006 ? 1500 : phi > 0.004 ? 1000 : 2500));
    CHECK(drawn.y[i] == 1200);
  }
  CHECK(box.style == TraceStyle::area);
  CHECK_THAT(box.x[0], Catch::WithinAbs(-0.006, 1e-12));
  CHECK_THAT(box.x[1], Catch::WithinAbs(0.004, 1e-12));
  CHECK(box.y[2] > 2500);
  CHECK(figure.notes.size() == 3);
  CHECK(figure.marks.size() == 2);
}

}  // namespace
