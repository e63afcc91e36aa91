// Every row of the table of load laws keeps the promises of load.hpp.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/load.hpp"

namespace {

using namespace cablefit;

/// An example of each law, as in a rig file, with the torque at q = 0.3 and the inertia by hand.
struct Example {
  std::string json;
  double torque, inertia;
};

const std::map<std::string, Example, std::less<>>& examples() {
  static const std::map<std::string, Example, std::less<>> kExamples{
      {"column", {R"({"type": "column"})", 0, 0}},
      {"constant", {R"({"type": "constant", "torque": -12.8})", -12.8, 0}},
      // - 40 kg * 9.80665 m/s^2 * 0.1 m; 40 * 0.1^2
      {"hanging_mass",
       {R"({"type": "hanging_mass", "mass": 40, "radius": 0.1, "direction": -1})", -39.2266, 0.4}},
      // - 2 kg * 9.80665 m/s^2 * 0.3 m * sin(0.3 - 0.1); 2 * 0.3^2
      {"pendulum",
       {R"({"type": "pendulum", "mass": 2, "length": 0.3, "zero": 0.1})",
        -5.88399 * 0.19866933079506122, 0.18}},
      {"table", {R"({"type": "table", "q": [-1, 0, 1], "torque": [5, 2, -8]})", -1, 0}},
      {"none", {R"({"type": "none"})", 0, 0}},
  };
  return kExamples;
}

TEST_CASE("a load law reads its keys and gives its torque", "[conformance]") {
  for (const LoadLaw& law : load_laws()) {
    INFO(law.name);
    const auto found = examples().find(law.name);
    REQUIRE(found != examples().end());  // a new law needs an example above
    const Example& example = found->second;
    const LoadParameters parameters = law.read(parse_json(example.json, "rig.json"));
    CHECK(std::abs(law.torque(parameters, 0.3) - example.torque) <=
          1e-13 * std::abs(example.torque));
    CHECK(std::abs(law.inertia(parameters) - example.inertia) <= 1e-15);
    CHECK(&find_load_law(law.name) == &law);
    CHECK_FALSE(law.equation.empty());
  }
  CHECK(examples().size() == load_laws().size());
}

TEST_CASE("a load law writes back what it read", "[conformance]") {
  for (const LoadLaw& law : load_laws()) {
    INFO(law.name);
    const JsonNode node = parse_json(examples().find(law.name)->second.json, "rig.json");
    const auto entries = law.entries(law.read(node));
    CHECK(entries.size() == node.members.size() - 1);
    for (const auto& [key, value] : entries) {
      const JsonNode& written = node.at(key);
      if (const double* number = std::get_if<double>(&value)) {
        CHECK(*number == written.number());
      } else {
        CHECK(std::get<std::vector<double>>(value) == written.numbers());
      }
    }
  }
}

TEST_CASE("a load law refuses keys that are not its own", "[conformance]") {
  for (const LoadLaw& law : load_laws()) {
    INFO(law.name);
    std::string json = examples().find(law.name)->second.json;
    json.insert(json.size() - 1, R"(, "weight": 3)");
    CHECK_THROWS_WITH(law.read(parse_json(json, "rig.json")), Catch::Contains("'weight'"));
  }
}

TEST_CASE("a load law's slope is that of its torque", "[conformance]") {
  const LoadParameters parameters{.torque = 2,
                                  .mass = 1,
                                  .radius = 0.1,
                                  .length = 0.3,
                                  .zero = 0.2,
                                  .q = {-0.5, 0.1, 0.4},
                                  .table_torque = {1, -2, 3}};
  for (const LoadLaw& law : load_laws()) {
    INFO(law.name);
    for (const double q : {-0.7, -0.2, 0.25, 0.6}) {
      // Central differences, h^2 / 6 of a third derivative of 3, and rounding 1e-16 / h.
      const double central =
          (law.torque(parameters, q + 1e-5) - law.torque(parameters, q - 1e-5)) / 2e-5;
      CHECK(std::abs((law.slope ? law.slope(parameters, q) : 0) - central) <= 1e-9);
    }
  }
}

TEST_CASE("a pendulum is driven back to its zero, a hanging mass up or down", "[model]") {
  const LoadLaw& pendulum = find_load_law("pendulum");
  LoadParameters p;
  p.mass = 1;
  p.length = 0.3;
  CHECK(pendulum.torque(p, 0.1) < 0);
  CHECK(pendulum.torque(p, -0.1) > 0);
  const LoadLaw& hanging = find_load_law("hanging_mass");
  p.radius = 0.1;
  CHECK(hanging.torque(p, 0) > 0);
  p.direction = -1;
  CHECK(hanging.torque(p, 0) < 0);
}

TEST_CASE("a load table is linear between its points and constant outside", "[model]") {
  const LoadLaw& table = find_load_law("table");
  LoadParameters p;
  p.q = {0, 1, 3};
  p.table_torque = {2, 4, -4};
  CHECK(table.torque(p, -5) == 2);
  CHECK(table.torque(p, 0) == 2);
  CHECK(table.torque(p, 0.25) == 2.5);
  CHECK(table.torque(p, 1) == 4);
  CHECK(table.torque(p, 2) == 0);
  CHECK(table.torque(p, 3) == -4);
  CHECK(table.torque(p, 9) == -4);
}

}  // namespace
