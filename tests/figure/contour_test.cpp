// Lines and areas of maps against shapes known in closed form.
#include "cablefit/figure/contour.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;
using Eigen::VectorXd;

template <typename Function>
Eigen::MatrixXd sampled(const VectorXd& x, const VectorXd& y, Function f) {
  Eigen::MatrixXd values(x.size(), y.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    for (Eigen::Index j = 0; j < y.size(); ++j) values(i, j) = f(x(i), y(j));
  return values;
}

double circle(double x, double y) { return 1 - x * x - y * y; }

/// Length of all pieces.
double length(const Trace& line) {
  double sum = 0;
  for (std::size_t k = 1; k < line.x.size(); ++k)
    if (std::isfinite(line.x[k]) && std::isfinite(line.x[k - 1]))
      sum += std::hypot(line.x[k] - line.x[k - 1], line.y[k] - line.y[k - 1]);
  return sum;
}

/// Area within all outlines (shoelace), those that run clockwise taken off. Each one is closed.
double area(const Trace& outlines) {
  double sum = 0;
  std::size_t first = 0;
  for (std::size_t k = 0; k < outlines.x.size(); ++k) {
    if (std::isnan(outlines.x[k])) {
      first = k + 1;
    } else if (k > first) {
      sum += outlines.x[k - 1] * outlines.y[k] - outlines.x[k] * outlines.y[k - 1];
    }
    if (k + 1 == outlines.x.size() || std::isnan(outlines.x[k + 1])) {
      CHECK(outlines.x[k] == outlines.x[first]);
      CHECK(outlines.y[k] == outlines.y[first]);
      ++k;
      first = k + 1;
    }
  }
  return sum / 2;
}

std::ptrdiff_t n_breaks(const Trace& trace) {
  return std::count_if(trace.x.begin(), trace.x.end(), [](double v) { return std::isnan(v); });
}

TEST_CASE("the zero line of a plane is exact, whichever way it runs") {
  const VectorXd x = VectorXd::LinSpaced(7, -1, 2), y = VectorXd::LinSpaced(5, 0, 1);
  const auto check = [&](double a, double b, double c, double expected) {
    Trace line;
    draw_zero_lines(x, y, sampled(x, y, [&](double u, double v) { return a * u + b * v + c; }),
                    line);
    for (std::size_t k = 0; k < line.x.size(); ++k)
      if (!std::isnan(line.x[k])) CHECK(std::abs(a * line.x[k] + b * line.y[k] + c) < 1e-14);
    CHECK(n_breaks(line) == 0);
    CHECK(length(line) == Approx(expected).epsilon(1e-12));
  };
  check(1, 0, -0.3, 1);                   // upright
  check(0, 1, -0.3, 3);                   // level
  check(1, -1, 0.05, std::sqrt(2) * 1);   // from (-0.05, 0) to (0.95, 1)
  check(-2, 1, 0.1, std::hypot(1, 0.5));  // from (0.05, 0) to (0.55, 1)
  check(1, 1, 5, 0);                      // not here
}

TEST_CASE("a circle is drawn as its chords") {
  const VectorXd x = VectorXd::LinSpaced(101, -1.5, 1.5), y = VectorXd::LinSpaced(81, -1.2, 1.2);
  Trace line;
  draw_zero_lines(x, y, sampled(x, y, circle), line);
  // h = 0.03; linear interpolation along an edge is off by h^2/8 |f''| / |f'| = h^2/8 at most where
  // the edge is crossed at 45 degrees or steeper, sqrt(2) times that elsewhere.
  for (std::size_t k = 0; k < line.x.size(); ++k)
    if (!std::isnan(line.x[k])) CHECK(std::abs(std::hypot(line.x[k], line.y[k]) - 1) < 2.5e-4);
  CHECK(length(line) == Approx(2 * M_PI).epsilon(1e-3));
  CHECK(n_breaks(line) == 0);  // one line, so that dashes run along it
  CHECK(line.x.front() == line.x.back());
  Trace filled;
  draw_positive_area(x, y, sampled(x, y, circle), filled);
  CHECK(area(filled) == Approx(M_PI).epsilon(1e-3));
}

TEST_CASE("the hole of a ring is taken off") {
  const VectorXd x = VectorXd::LinSpaced(401, -1.5, 1.5), y = x;
  const auto ring = [](double u, double v) {
    const double r2 = u * u + v * v;
    return (1 - r2) * (r2 - 0.25);
  };
  Trace filled;
  draw_positive_area(x, y, sampled(x, y, ring), filled);
  CHECK(n_breaks(filled) == 1);
  CHECK(area(filled) == Approx(0.75 * M_PI).epsilon(1e-3));
}

TEST_CASE("two positive corners of a cell are one area") {
  const Eigen::Vector2d x(0, 1), y(0, 1);
  Eigen::Matrix2d saddle;
  saddle << 1, -1, -1, 1;
  Trace lines, filled;
  draw_zero_lines(x, y, saddle, lines);
  CHECK(n_breaks(lines) == 1);
  draw_positive_area(x, y, saddle, filled);
  CHECK(n_breaks(filled) == 0);
  CHECK(area(filled) == Approx(0.75));  // without the corners of 1/8 each
}

TEST_CASE("an area ends at the edge of the map, and nothing is nothing") {
  const VectorXd x = VectorXd::LinSpaced(3, 0, 2), y = VectorXd::LinSpaced(4, -1, 2);
  Trace all, none;
  draw_positive_area(x, y, Eigen::MatrixXd::Constant(3, 4, 1), all);
  CHECK(area(all) == Approx(6));
  draw_positive_area(x, y, Eigen::MatrixXd::Constant(3, 4, 0), none);
  CHECK(none.x.empty());
}

}  // namespace
