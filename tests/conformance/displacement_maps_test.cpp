// Every row of the table of displacement maps keeps the promises of routing.hpp.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "cablefit/base/error.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/routing.hpp"

namespace {

using namespace cablefit;

/// A map of each kind as a rig file has it; the table is that of a pulley about 20 mm in radius.
const std::map<std::string, std::string, std::less<>> kExamples{
    {"radius", R"({"type": "radius", "radius": -0.03})"},
    {"polynomial", R"({"type": "polynomial", "coefficients": [0.02, -0.004, 0.003, 0.001]})"},
    {"table", R"({"type": "table", "angle": [-1.2, -0.7, -0.1, 0.4, 1.1, 1.5],
                  "displacement": [-0.02, -0.013, -0.002, 0.009, 0.022, 0.033]})"}};

/// Runs `check(map)` for every kind.
template <typename Check>
void for_every_map(Check check) {
  for (const MapKind& kind : map_kinds()) {
    INFO(kind.name);
    const auto example = kExamples.find(kind.name);
    REQUIRE(example != kExamples.end());
    check(DisplacementMap{&kind, kind.read(parse_json(example->second, "map.json"))});
  }
}

/// Angles within the table, on its points, and beyond both ends.
constexpr double kAngles[] = {-3.1, -1.3, -1.0, -0.69, -0.2, 0.0, 0.11, 0.7, 1.2, 1.51, 2.8};

TEST_CASE("a map's radius and its slope are derivatives of its displacement", "[conformance]") {
  for_every_map([](const DisplacementMap& map) {
    constexpr double kStep = 1e-5;
    for (const double x : kAngles) {
      const double radius =
          (map.displacement(x + kStep) - map.displacement(x - kStep)) / (2 * kStep);
      const double slope = (map.radius(x + kStep) - map.radius(x - kStep)) / (2 * kStep);
      // Third derivatives are below 0.2 m/rad^3: h^2/6 of them is 4e-12; rounding of 0.1 m over h
      // is 1e-12.
      INFO("at " << x);
      CHECK(std::abs(map.radius(x) - radius) < 1e-11);
      CHECK(std::abs(map.radius_slope(x) - slope) < 1e-11);
    }
  });
}

TEST_CASE("a map and its radius are continuous", "[conformance]") {
  for_every_map([](const DisplacementMap& map) {
    for (int i = -3000; i <= 3000; ++i) {
      const double x = 0.001 * i;
      constexpr double kStep = 1e-7;
      // Radii are below 0.2 m and their slopes below 0.2 m/rad.
      CHECK(std::abs(map.displacement(x + kStep) - map.displacement(x)) < 0.2 * kStep);
      CHECK(std::abs(map.radius(x + kStep) - map.radius(x)) < 0.2 * kStep);
    }
  });
}

TEST_CASE("a constant radius is constant, and arrays are what single angles are", "[conformance]") {
  for_every_map([](const DisplacementMap& map) {
    const Eigen::Map<const Eigen::ArrayXd> angles(kAngles, std::size(kAngles));
    const Eigen::ArrayXd displacements = map.displacements(angles), radii = map.radii(angles);
    bool constant = true;
    for (Eigen::Index i = 0; i < angles.size(); ++i) {
      CHECK(displacements[i] == map.displacement(angles[i]));
      CHECK(radii[i] == map.radius(angles[i]));
      constant = constant && radii[i] == radii[0];
    }
    CHECK(constant == map.kind->constant_radius);
    CHECK_FALSE(map.is_zero());
  });
}

TEST_CASE("a map writes back what it read", "[conformance]") {
  for_every_map([](const DisplacementMap& map) {
    const JsonNode example = parse_json(kExamples.find(map.kind->name)->second, "map.json");
    std::size_t n = 1;  // "type"
    for (const auto& [key, value] : map.kind->entries(map.parameters)) {
      ++n;
      if (const double* number = std::get_if<double>(&value)) {
        CHECK(*number == example.at(key).number());
      } else {
        CHECK(std::get<std::vector<double>>(value) == example.at(key).numbers());
      }
    }
    CHECK(n == example.members.size());
  });
}

TEST_CASE("a map says what it is", "[conformance]") {
  for (const MapKind& kind : map_kinds()) {
    INFO(kind.name);
    CHECK_FALSE(kind.equation.empty());
    CHECK_FALSE(kind.source.empty());
    CHECK(&find_map_kind(kind.name) == &kind);
  }
  CHECK_THROWS_WITH(find_map_kind("tabel"),
                    "unknown displacement map 'tabel'; did you mean 'table'?");
}

TEST_CASE("a table of a cubic is that cubic, its tangents beyond") {
  const auto cubic = [](double x) { return 0.1 + 0.02 * x - 0.003 * x * x + 0.004 * x * x * x; };
  std::string angle, displacement;
  for (const double x : {-1.0, -0.4, 0.0, 0.7, 1.5}) {
    angle += (angle.empty() ? "" : ", ") + std::to_string(x);
    char number[32];
    std::snprintf(number, sizeof number, "%.17g", cubic(x));
    displacement += (displacement.empty() ? "" : ", ") + std::string(number);
  }
  const MapKind& table = find_map_kind("table");
  const DisplacementMap map{
      &table, table.read(parse_json(R"({"type": "table", "angle": [)" + angle +
                                        R"(], "displacement": [)" + displacement + "]}",
                                    "map.json"))};
  // Not-a-knot reproduces cubics; a few operations on numbers of 0.1: rounding 1e-16.
  for (const double x : {-0.9, -0.2, 0.3, 1.49})
    CHECK(std::abs(map.displacement(x) - cubic(x)) < 1e-15);
  const double end_radius = 0.02 - 0.006 * 1.5 + 0.012 * 1.5 * 1.5;
  CHECK(std::abs(map.radius(2.5) - end_radius) < 1e-15);
  CHECK(std::abs(map.displacement(2.5) - (cubic(1.5) + end_radius)) < 1e-15);
}

}  // namespace
