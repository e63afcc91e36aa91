// Force closure and disclosure as a map, against the closed form of simple rigs.
#include "cablefit/elastic/figures/mode_figure.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"

namespace {

using namespace cablefit;

constexpr double kRounding = 1e-14;  // of positions up to 1, a few operations each

Transmission preloaded_pair() {
  Transmission pair = antagonist_pair(1);
  pair.cables[0].initial_elongation = 0.006;
  pair.cables[1].initial_elongation = 0.004;
  return pair;
}

const Trace* find(const Figure& figure, const std::string& name) {
  for (const Trace& trace : figure.traces)
    if (trace.name == name) return &trace;
  return nullptr;
}

const Trace& line_of(const Figure& figure, const std::string& cable) {
  const Trace* line = find(figure, "cable " + cable + " goes slack");
  REQUIRE(line != nullptr);
  return *line;
}

/// Largest |l(q, theta)| on a line where it should be 0.
template <typename Elongation>
double off(const Trace& line, Elongation l) {
  double most = 0;
  for (std::size_t k = 0; k < line.x.size(); ++k)
    if (!std::isnan(line.x[k])) most = std::max(most, std::abs(l(line.x[k], line.y[k])));
  return most;
}

std::pair<double, double> ends(const std::vector<double>& values) {
  double low = kUnbounded, high = -kUnbounded;
  for (const double value : values)
    if (!std::isnan(value)) low = std::min(low, value), high = std::max(high, value);
  return {low, high};
}

/// The names of the regions, each checked to stand where it is true.
std::vector<std::string> regions(const Figure& figure, const Transmission& transmission) {
  std::vector<std::string> names;
  for (const Note& note : figure.notes) {
    names.push_back(note.text);
    const Eigen::VectorXd l = transmission.elongations(Eigen::VectorXd::Constant(1, note.x),
                                                       Eigen::VectorXd::Constant(1, note.y));
    std::string slack;
    for (std::size_t c = 0; c < transmission.cables.size(); ++c)
      if (!(l(static_cast<Eigen::Index>(c)) > 0))
        slack += (slack.empty() ? "slack: " : ", ") + transmission.cables[c].name;
    CHECK(note.text == (slack.empty() ? "all taut" : slack));
  }
  std::sort(names.begin(), names.end());
  return names;
}

using Names = std::vector<std::string>;

TEST_CASE("the map of a preloaded pair is a band along the diagonal", "[elastic]") {
  const Transmission pair = preloaded_pair();
  // The link was blocked at 0.1.
  const Figure figure = mode_figure(pair, 0, {0.1, 0.1}, {0.08, 0.12}, Axes::rotary);
  CHECK(off(line_of(figure, "1"), [](double q, double t) { return t - q + 0.006; }) < kRounding);
  CHECK(off(line_of(figure, "2"), [](double q, double t) { return q - t + 0.004; }) < kRounding);
  const Trace* band = find(figure, "all taut: force closure");
  REQUIRE(band != nullptr);
  CHECK(band->style == TraceStyle::area);
  const auto [q_low, q_high] = ends(band->x);
  CHECK(q_low == Approx(0.08));  // as much of q as was seen of theta
  CHECK(q_high == Approx(0.12));
  for (std::size_t k = 0; k < band->x.size(); ++k) {
    const double phi = band->y[k] - band->x[k];
    CHECK(phi > -0.006 - kRounding);
    CHECK(phi < 0.004 + kRounding);
  }
  CHECK(regions(figure, pair) == Names{"all taut", "slack: 1", "slack: 2"});
  CHECK(figure.x.unit == "rad");
}

TEST_CASE("a map counts theta from the encoder zero, as logs do", "[elastic]") {
  Transmission pair = preloaded_pair();
  pair.theta_0 = Eigen::VectorXd::Constant(1, 0.7);
  set_reference(pair, {Eigen::VectorXd::Constant(1, 0.2), Eigen::VectorXd::Constant(1, 0.2)});
  const Figure figure = mode_figure(pair, 0, {0.18, 0.22}, {0.88, 0.92}, Axes::rotary);
  CHECK(off(line_of(figure, "1"), [](double q, double t) { return t - 0.7 - q + 0.006; }) <
        kRounding);
  CHECK(regions(figure, pair) == Names{"all taut", "slack: 1", "slack: 2"});
}

TEST_CASE("without preload the cables change place on one line", "[elastic]") {
  const Transmission pair = antagonist_pair(2);
  const Figure figure = mode_figure(pair, 0, {0, 0}, {-0.02, 0.02}, Axes::rotary);
  CHECK(find(figure, "all taut: force closure") == nullptr);
  CHECK(off(line_of(figure, "1"), [](double q, double t) { return t - q; }) < kRounding);
  CHECK(off(line_of(figure, "2"), [](double q, double t) { return t - q; }) < kRounding);
  CHECK(line_of(figure, "1").style != line_of(figure, "2").style);  // both are seen
  CHECK(regions(figure, pair) == Names{"slack: 1", "slack: 2"});
}

TEST_CASE("a gear shows as much of q as it turns", "[elastic]") {
  Transmission pair = preloaded_pair();
  for (Cable& cable : pair.cables)
    cable.motor_map = round_pulleys(0.1 * cable.motor_radii(Eigen::VectorXd::Zero(1)));
  const Figure figure = mode_figure(pair, 0, {0, 0}, {-0.2, 0.2}, Axes::linear);
  const auto [low, high] = ends(find(figure, "all taut: force closure")->x);
  CHECK(low == Approx(-0.02));
  CHECK(high == Approx(0.02));
  CHECK(off(line_of(figure, "2"), [](double q, double t) { return q - 0.1 * t + 0.004; }) <
        kRounding);
  CHECK(figure.y.unit == "m");
  const Figure moved =
      mode_figure(pair, 0, {-0.5, 0.3}, {-4, 4}, Axes::linear);  // q as it was seen
  CHECK(ends(find(moved, "all taut: force closure")->x).second == Approx(0.3));
}

TEST_CASE("a pulley that is not round bends the line", "[elastic]") {
  // Radius 1 + 20 theta: l = theta + 10 theta^2 - q + 0.02.
  const Rig rig = parse_rig(parse_json(
      R"({"cables": [{"name": "a", "link_radius": 1, "initial_elongation": 0.02,
          "motor_radius": {"type": "polynomial", "coefficients": [1, 20]}}]})",
      "rig.json"));
  const Figure figure = mode_figure(rig.transmission, 0, {-0.02, 0.02}, {-0.2, 0.2}, Axes::rotary);
  // Steps of 1/300 in theta: h^2/8 l'' = 2.8e-5 off.
  CHECK(off(line_of(figure, "a"), [](double q, double t) { return t + 10 * t * t - q + 0.02; }) <
        2.8e-5);
  CHECK(regions(figure, rig.transmission) == Names{"all taut", "slack: a"});
}

TEST_CASE("a joint's map shows the cables that it moves", "[elastic]") {
  Transmission arm = antagonist_pairs(2, 1);
  for (Cable& cable : arm.cables) cable.initial_elongation = 0.005;
  arm.cables[0].initial_elongation = -1;  // slack in the reference pose, but joint 1 moves it
  const Figure figure = mode_figure(arm, 1, {0, 0}, {-0.02, 0.02}, Axes::rotary);
  CHECK(find(figure, "cable 1 goes slack") == nullptr);
  CHECK(off(line_of(figure, "3"), [](double q, double t) { return t - q + 0.005; }) < kRounding);
  Names names;
  for (const Note& note : figure.notes) names.push_back(note.text);
  std::sort(names.begin(), names.end());
  CHECK(names == Names{"all taut", "slack: 3", "slack: 4"});
  CHECK(figure.caption.find("reference pose") != std::string::npos);
}

}  // namespace
