// Every row of the table of maps of two joints keeps the promises of pair_maps.hpp.
#include "cablefit/model/pair_maps/pair_maps.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"

namespace {

using namespace cablefit;

const std::map<std::string, std::string, std::less<>> kExamples{
    {"polynomial", R"({"type": "polynomial", "joints": ["a", "b"],
                       "coefficients": [[0, 0.02, -0.004], [0.01, 0.006, 0.002], [0.003, 0, 0.001]]})"},
    {"guides", R"({"type": "guides", "joints": ["a", "b"], "from": [-0.05, 0.012],
                   "to": [0.03, 0.015], "length": 0.04})"},
    {"grid", R"({"type": "grid", "joints": ["a", "b"], "angle_1": [-1, -0.4, 0.1, 0.7, 1.2],
                 "angle_2": [-0.8, 0, 0.5, 1],
                 "displacement": [[-0.03, -0.02, -0.012, -0.004], [-0.02, -0.008, -0.001, 0.008],
                                  [-0.013, 0.002, 0.01, 0.02], [-0.005, 0.013, 0.025, 0.035],
                                  [0.003, 0.024, 0.036, 0.044]]})"}};

PairMap example_of(const PairMapKind& kind, MapSide side = MapSide::motor) {
  const auto example = kExamples.find(kind.name);
  REQUIRE(example != kExamples.end());
  return {&kind, kind.read(parse_json(example->second, "map.json"), side), {0, 1}};
}

template <typename Check>
void for_every_map(Check check) {
  for (const PairMapKind& kind : pair_map_kinds()) {
    INFO(kind.name);
    check(example_of(kind));
  }
}

/// Angles within the grid, on its lines, and beyond its sides; at an end the second derivative
/// steps.
constexpr double kAngles[] = {-1.3, -0.97, -0.69, -0.4, 0.0, 0.11, 0.5, 0.9, 1.3};

TEST_CASE("radii of two joints and their slopes are derivatives", "[conformance]") {
  for_every_map([](const PairMap& map) {
    constexpr double kStep = 1e-5;
    for (const double x1 : kAngles)
      for (const double x2 : kAngles) {
        INFO("at " << x1 << ", " << x2);
        const PairValue at = map.at(x1, x2);
        const Eigen::Vector2d steps[] = {{kStep, 0}, {0, kStep}};
        for (const int k : {0, 1}) {
          const PairValue up = map.at(x1 + steps[k].x(), x2 + steps[k].y());
          const PairValue down = map.at(x1 - steps[k].x(), x2 - steps[k].y());
          const double radius = (up.displacement - down.displacement) / (2 * kStep);
          // Third derivatives are below 0.5 m/rad^3: h^2/6 of them is 1e-11; on a line of the grid
          // the third derivative jumps, as much as h/2 of the second: 1e-11 again.
          CHECK(std::abs(at.radius(k) - radius) < 3e-11);
          const Eigen::Vector2d slope = (up.radius - down.radius) / (2 * kStep);
          // On a line of the grid the second derivative has a corner.
          const bool on_line = x1 == -0.4 || x2 == 0 || x2 == 0.5;
          if (map.kind->name == "grid" && on_line) continue;
          CHECK(std::abs(at.slope(0, k) - slope(0)) < 3e-11);
          CHECK(std::abs(at.slope(1, k) - slope(1)) < 3e-11);
        }
        CHECK(at.slope(0, 1) == at.slope(1, 0));
      }
  });
}

TEST_CASE("a map of two joints and its radii are continuous", "[conformance]") {
  for_every_map([](const PairMap& map) {
    for (int i = -1500; i <= 1500; ++i)
      for (const double other : {-1.1, -0.2, 0.4, 1.4}) {
        constexpr double kStep = 1e-7;
        const double x = 0.001 * i;
        // Radii are below 0.2 m and their slopes below 0.5 m/rad.
        CHECK((map.at(x + kStep, other).radius - map.at(x, other).radius).norm() < 0.5 * kStep);
        CHECK((map.at(other, x + kStep).radius - map.at(other, x).radius).norm() < 0.5 * kStep);
        CHECK(std::abs(map.at(x + kStep, other).displacement - map.at(x, other).displacement) <
              0.2 * kStep);
      }
  });
}

TEST_CASE("a map of two joints writes back what it read", "[conformance]") {
  for_every_map([](const PairMap& map) {
    const JsonNode example = parse_json(kExamples.find(map.kind->name)->second, "map.json");
    std::size_t n = 2;  // "type", "joints"
    for (const auto& [key, value] : map.kind->entries(map.parameters)) {
      ++n;
      const JsonNode& node = example.at(key);
      if (const auto* number = std::get_if<double>(&value)) {
        CHECK(*number == node.number());
      } else if (const auto* list = std::get_if<std::vector<double>>(&value)) {
        CHECK(*list == node.numbers());
      } else {
        const auto& lists = std::get<std::vector<std::vector<double>>>(value);
        REQUIRE(lists.size() == node.items.size());
        for (std::size_t i = 0; i < lists.size(); ++i) CHECK(lists[i] == node.items[i].numbers());
      }
    }
    CHECK(n == example.members.size());
  });
}

TEST_CASE("a map of two joints times a factor is a map", "[conformance]") {
  for_every_map([](const PairMap& map) {
    const PairMap twice = scaled(map, 2);
    for (const double x1 : kAngles) {
      CHECK(twice.at(x1, 0.3).displacement ==
            Approx(2 * map.at(x1, 0.3).displacement).epsilon(1e-12).margin(1e-16));
      CHECK((twice.at(x1, 0.3).slope - 2 * map.at(x1, 0.3).slope).norm() < 1e-15);
    }
  });
}

TEST_CASE("a map of two joints says what it is", "[conformance]") {
  for (const PairMapKind& kind : pair_map_kinds()) {
    CHECK_FALSE(kind.equation.empty());
    CHECK_FALSE(kind.source.empty());
    CHECK(&find_pair_map_kind(kind.name) == &kind);
  }
  CHECK_THROWS_WITH(find_pair_map_kind("gird"),
                    "unknown map of two joints 'gird'; did you mean 'grid'?");
}

/// Distance of a point of link 2 from one of the base, by the law of cosines in the triangle
/// axis 1 - axis 2 - point, then in the triangle base point - axis 1 - point.
double by_triangles(double from_x, double from_y, double to_x, double to_y, double length,
                    double x1, double x2) {
  const double to = std::hypot(to_x, to_y), at_axis_2 = std::atan2(to_y, to_x) + x2;
  const double reach = std::sqrt(length * length + to * to + 2 * length * to * std::cos(at_axis_2));
  const double ahead = std::atan2(to * std::sin(at_axis_2), length + to * std::cos(at_axis_2));
  const double from = std::hypot(from_x, from_y);
  const double between = x1 + ahead - std::atan2(from_y, from_x);
  return std::sqrt(reach * reach + from * from - 2 * reach * from * std::cos(between));
}

TEST_CASE("a tendon between guides has the length of two triangles") {
  const PairMap motor = example_of(find_pair_map_kind("guides"));
  const PairMap link = example_of(find_pair_map_kind("guides"), MapSide::link);
  const auto way = [](double x1, double x2) {
    return by_triangles(-0.05, 0.012, 0.03, 0.015, 0.04, x1, x2);
  };
  for (const double x1 : kAngles)
    for (const double x2 : kAngles) {
      // Sums of lengths of 0.1 m: rounding of a few 1e-17 under a square root of 1e-3.
      const double longer = way(x1, x2) - way(0, 0);
      CHECK(std::abs(motor.at(x1, x2).displacement - longer) < 1e-15);
      CHECK(std::abs(link.at(x1, x2).displacement + longer) < 1e-15);
    }
}

TEST_CASE("a lever of a tendon between guides is its distance from the axis") {
  const PairMap map = example_of(find_pair_map_kind("guides"), MapSide::link);
  for (const double x1 : {-0.4, 0.0, 0.3})
    for (const double x2 : {-0.3, 0.0, 0.6}) {
      // The line through both guides, and the distances of both axes from it.
      const Eigen::Vector2d axis_2 = 0.04 * Eigen::Vector2d(std::cos(x1), std::sin(x1));
      const Eigen::Vector2d to =
          axis_2 + Eigen::Rotation2Dd(x1 + x2) * Eigen::Vector2d(0.03, 0.015);
      const Eigen::Vector2d from(-0.05, 0.012), along = (to - from).normalized();
      const auto distance = [&](const Eigen::Vector2d& axis) {
        const Eigen::Vector2d arm = from - axis;
        return arm.y() * along.x() - arm.x() * along.y();
      };
      CHECK(map.at(x1, x2).radius(0) == Approx(distance({0, 0})).epsilon(1e-12));
      CHECK(map.at(x1, x2).radius(1) == Approx(distance(axis_2)).epsilon(1e-12));
    }
}

/// A grid of a function.
PairMap grid_of(const std::function<double(double, double)>& f, int n_1, int n_2) {
  std::vector<double> angle_1, angle_2;
  std::vector<std::vector<double>> rows;
  for (int i = 0; i < n_1; ++i) angle_1.push_back(-1 + 2.0 * i / (n_1 - 1));
  for (int j = 0; j < n_2; ++j) angle_2.push_back(-0.9 + 1.7 * j / (n_2 - 1));
  std::string lists;
  for (const double x1 : angle_1) {
    std::vector<double> row;
    for (const double x2 : angle_2) row.push_back(f(x1, x2));
    lists += fmt::format("{}[{:.17g}]", lists.empty() ? "" : ", ", fmt::join(row, ", "));
  }
  const PairMapKind& grid = find_pair_map_kind("grid");
  const std::string text = fmt::format(
      R"({{"type": "grid", "joints": ["a", "b"], "angle_1": [{:.17g}], "angle_2": [{:.17g}], "displacement": [{}]}})",
      fmt::join(angle_1, ", "), fmt::join(angle_2, ", "), lists);
  return {&grid, grid.read(parse_json(text, "map.json"), MapSide::link), {0, 1}};
}

TEST_CASE("a grid of a bicubic is that bicubic, its tangents beyond") {
  const auto one = [](double x) { return 0.1 + 0.2 * x - 0.3 * x * x + 0.15 * x * x * x; };
  const auto two = [](double x) { return 0.2 - 0.1 * x + 0.2 * x * x - 0.05 * x * x * x; };
  const auto two_slope = [](double x) { return -0.1 + 0.4 * x - 0.15 * x * x; };
  const PairMap map = grid_of([&](double x1, double x2) { return one(x1) * two(x2); }, 5, 6);
  for (const double x1 : {-0.9, -0.2, 0.3, 0.99})
    for (const double x2 : {-0.8, 0.1, 0.79}) {
      // Sums of 16 products of numbers up to 1: rounding of some 1e-16.
      CHECK(std::abs(map.at(x1, x2).displacement - one(x1) * two(x2)) < 2e-15);
      CHECK(std::abs(map.at(x1, x2).radius(1) - one(x1) * two_slope(x2)) < 2e-14);
      const double beyond = one(x1) * (two(0.8) + 0.4 * two_slope(0.8));
      CHECK(std::abs(map.at(x1, 1.2).displacement - beyond) < 1e-14);
    }
}

TEST_CASE("a finer grid comes to the closed form with the fourth power of its step") {
  const auto way = [](double x1, double x2) {
    return by_triangles(-0.05, 0.012, 0.03, 0.015, 0.04, x1, x2);
  };
  const auto error = [&](int n) {
    const PairMap map = grid_of(way, n, n);
    double most = 0;
    for (double x1 = -0.5; x1 < 0.5; x1 += 0.037)
      for (double x2 = -0.5; x2 < 0.5; x2 += 0.031)
        most = std::max(most, std::abs(map.at(x1, x2).displacement - way(x1, x2)));
    return most;
  };
  const double coarse = error(11), fine = error(21);
  CHECK(coarse < 1e-6);
  CHECK(fine < coarse / 10);  // 16 but for terms of higher order
}

}  // namespace
