#include <fmt/core.h>

#include <cmath>

#include "cablefit/model/json_reading.hpp"
#include "cablefit/model/pair_maps/kinds.hpp"

namespace cablefit::pair_maps {
namespace {

using Eigen::Vector2d;

Vector2d read_point(const JsonNode& node) {
  const std::vector<double> xy = node.numbers();
  if (xy.size() != 2)
    throw node.error(fmt::format("{} number(s), expected 2", xy.size()), "give [x, y] in m");
  return {xy[0], xy[1]};
}

/// The second guide and what turns it: p from axis 1, r from axis 2.
struct Guide {
  Vector2d p, r;
};

Guide guide_at(const PairParameters& g, double x1, double x2) {
  const double s = std::sin(x1 + x2), c = std::cos(x1 + x2);
  const Vector2d r(c * g.to.x() - s * g.to.y(), s * g.to.x() + c * g.to.y());
  return {r + g.length * Vector2d(std::cos(x1), std::sin(x1)), r};
}

Vector2d turned(const Vector2d& v) { return {-v.y(), v.x()}; }

double straight(const PairParameters& g) { return (guide_at(g, 0, 0).p - g.from).norm(); }

PairParameters read(const JsonNode& node, MapSide side) {
  node.allow_only({"type", "joints", "from", "to", "length"});
  PairParameters g;
  g.from = read_point(node.at("from"));
  g.to = read_point(node.at("to"));
  g.length = not_negative(node.at("length"));
  g.sign = side == MapSide::motor ? 1 : -1;
  if (straight(g) == 0)
    throw node.error("the guides meet with both joints at 0", "give two places of the tendon");
  if (g.from.isZero(0))
    throw node.at("from").error("the guide is on axis 1, which then moves no cable",
                                "give the map of joint 2 alone in motor_radius or link_radius");
  if (g.to.isZero(0))
    throw node.at("to").error("the guide is on axis 2, which then moves no cable",
                              "give the map of joint 1 alone in motor_radius or link_radius");
  return g;
}

std::vector<PairEntry> entries(const PairParameters& g) {
  return {{"from", std::vector<double>{g.from.x(), g.from.y()}},
          {"to", std::vector<double>{g.to.x(), g.to.y()}},
          {"length", g.length}};
}

/// d = |p - from|; the derivative of p by x1 is p turned by 90 degrees, that by x2 is r turned.
PairValue at(const PairParameters& g, double x1, double x2) {
  const auto [p, r] = guide_at(g, x1, x2);
  const Vector2d span = p - g.from, by_1 = turned(p), by_2 = turned(r);
  const double d = span.norm();
  const Vector2d unit = span / d;
  const double d1 = unit.dot(by_1), d2 = unit.dot(by_2);
  const double d12 = (by_1.dot(by_2) - d1 * d2) / d - unit.dot(r);
  PairValue all;
  all.displacement = g.sign * (d - straight(g));
  all.radius << g.sign * d1, g.sign * d2;
  all.slope << (by_1.squaredNorm() - d1 * d1) / d - unit.dot(p), d12, d12,
      (by_2.squaredNorm() - d2 * d2) / d - unit.dot(r);
  all.slope *= g.sign;
  return all;
}

}  // namespace

PairMapKind guides() {
  return {
      .name = "guides",
      .equation = "path |R(x1) (length e_x + R(x2) to) - from|, less that at 0; in h its negative",
      .source = "plane geometry; radius as derivative of the path: An et al. 1984",
      .rotary_only = true,
      .read = read,
      .entries = entries,
      .at = at};
}

}  // namespace cablefit::pair_maps
