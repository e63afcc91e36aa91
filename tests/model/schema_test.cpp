// data/schema/ documents what the readers accept: the same keys, effects, laws and channels.
#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <vector>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using test::message_of;
using test::TempFolder;
using Names = std::set<std::string>;

JsonNode schema(const std::string& name) {
  return read_json_file(std::string(CABLEFIT_DATA) + "/schema/" + name + ".schema.json");
}

Names properties(const JsonNode& schema_node) {
  Names names;
  for (const auto& member : schema_node.at("properties").members) names.insert(member.first);
  return names;
}

Names texts(const JsonNode& list) {
  const std::vector<std::string> all = list.texts();
  return {all.begin(), all.end()};
}

/// The names behind "known: " in the message about an unknown one.
Names known_names(const std::string& message) {
  const auto start = message.find("known: ");
  REQUIRE(start != std::string::npos);
  std::string name;
  Names names;
  for (const char c : message.substr(start + 7) + ",") {
    if (c == ',') names.insert(std::exchange(name, ""));
    if (c != ',' && c != ' ') name += c;
  }
  return names;
}

Names known_to_rig_reader(const std::string& rig) {
  return known_names(message_of([&] { (void)parse_rig(parse_json(rig, "rig.json")); }));
}

Names known_to_model_reader(const std::string& model) {
  const TempFolder folder;
  const std::string path = folder.write("model.json", model);
  std::string choice;
  return known_names(message_of([&] { (void)read_model(path, "", "", choice); }));
}

TEST_CASE("the rig schema has the reader's keys") {
  const JsonNode root = schema("rig");
  const JsonNode& keys = root.at("properties");
  CHECK(properties(root) == known_to_rig_reader(R"({"?": 0})"));
  CHECK(properties(keys.at("controller").at("oneOf").items.front()) ==
        known_to_rig_reader(R"({"controller": {"?": 0}})"));
  CHECK(properties(keys.at("cables").at("items")) ==
        known_to_rig_reader(R"({"cables": [{"?": 0}]})"));
  CHECK(properties(keys.at("joints").at("items")) ==
        known_to_rig_reader(R"({"joints": [{"?": 0}]})"));
  const JsonNode& sensor = keys.at("sensors").at("patternProperties").members.front().second;
  CHECK(properties(sensor) == known_to_rig_reader(R"({"sensors": {"q": {"?": 0}}})"));
  const JsonNode& column = root.at("$defs").at("numeric_column").at("oneOf").items.at(1);
  CHECK(properties(column) == known_to_rig_reader(R"({"columns": {"q": {"?": 0}}})"));
}

TEST_CASE("the rig schema has every load law and cable law") {
  const JsonNode root = schema("rig");
  Names loads, laws;
  for (const JsonNode& load : root.at("properties").at("load").at("oneOf").items) {
    const std::string type = load.at("properties").at("type").at("const").text();
    loads.insert(type);
    INFO(type);
    CHECK(properties(load) ==
          known_to_rig_reader(R"({"load": {"type": ")" + type + R"(", "?": 0}})"));
  }
  CHECK(loads == known_to_rig_reader(R"({"load": {"type": "?"}})"));
  const JsonNode& cable = root.at("properties").at("cables").at("items").at("properties");
  for (const CableLaw& law : cable_laws()) laws.insert(std::string(law.name));
  CHECK(texts(cable.at("law").at("enum")) == laws);
}

TEST_CASE("the rig schema has every arm") {
  const JsonNode root = schema("rig");
  Names arms;
  for (const JsonNode& arm : root.at("properties").at("arm").at("oneOf").items) {
    const std::string type = arm.at("properties").at("type").at("const").text();
    arms.insert(type);
    INFO(type);
    CHECK(properties(arm) ==
          known_to_rig_reader(R"({"arm": {"type": ")" + type + R"(", "?": 0}})"));
  }
  CHECK(arms == known_to_rig_reader(R"({"arm": {"type": "?"}})"));
}

TEST_CASE("the rig schema has every displacement map") {
  const JsonNode root = schema("rig");
  const std::string start = R"({"cables": [{"name": "a", "motor_radius": {"type": ")";
  Names maps;
  for (const JsonNode& map : root.at("$defs").at("map").at("oneOf").items) {
    if (!map.find("properties")) continue;  // a bare number
    const std::string type = map.at("properties").at("type").at("const").text();
    maps.insert(type);
    CHECK(properties(map) == known_to_rig_reader(start + type + R"(", "?": 0}}]})"));
  }
  CHECK(maps == known_to_rig_reader(start + R"(?"}}]})"));
  CHECK(properties(root.at("$defs").at("searched")) ==
        known_to_rig_reader(R"({"cables": [{"motor_radius": {"search": 1, "?": 0}}]})"));
}

TEST_CASE("the rig schema has every map of two joints") {
  const JsonNode root = schema("rig");
  const std::string start =
      R"({"cables": [{"name": "a", "motor_radius": 1, "link_map": {"type": ")";
  Names maps;
  for (const JsonNode& map : root.at("$defs").at("pair_map").at("oneOf").items) {
    const std::string type = map.at("properties").at("type").at("const").text();
    maps.insert(type);
    CHECK(properties(map) == known_to_rig_reader(start + type + R"(", "?": 0}}]})"));
  }
  CHECK(maps == known_to_rig_reader(start + R"(?"}}]})"));
}

/// A model file needs all parameters of a row but those that may be 0.
void check_parameters(const JsonNode& node, const Effect& row) {
  Names names, required;
  for (std::size_t k = 0; k < row.parameters.size(); ++k) {
    names.insert(std::string(row.parameters[k].name));
    if (!may_be_left_out(row, k)) required.insert(std::string(row.parameters[k].name));
  }
  CHECK(properties(node) == names);
  CHECK(texts(node.at("required")) == required);
}

TEST_CASE("the effects schema has the base model with its parameters") {
  const JsonNode root = schema("effects");
  for (const Side side : {Side::link, Side::motor, Side::rigid}) {
    const JsonNode& side_node = root.at("$defs").at(to_string(side));
    Names names;
    for (const Effect& effect : base_effects(side)) {
      names.insert(std::string(effect.name));
      check_parameters(side_node.at("properties").at(effect.name), effect);
    }
    CHECK(properties(side_node) == names);
  }
}

TEST_CASE("the effects schema has every row of the catalogue with its parameters") {
  const JsonNode root = schema("effects");
  const JsonNode& refinement = root.at("$defs").at("refinement");
  const std::vector<JsonNode>& options = refinement.at("oneOf").items;
  // Without the row that another test adds: it names no source.
  std::vector<Effect> rows(candidate_effects().begin(), candidate_effects().end());
  std::erase_if(rows, [](const Effect& row) { return row.source.empty(); });
  REQUIRE(options.size() == rows.size());
  Names names, sides;
  for (std::size_t k = 0; k < options.size(); ++k) {
    const Effect& row = rows[k];
    const JsonNode& keys = options[k].at("properties");
    names.insert(std::string(row.name));
    sides.insert(std::string(to_string(row.site)));
    CHECK(keys.at("name").at("const").text() == row.name);
    CHECK(keys.at("side").at("const").text() == to_string(row.site));
    check_parameters(keys.at("parameters"), row);
    CHECK(texts(options[k].at("required")).count("event") == (row.is_event ? 1 : 0));
  }
  const JsonNode& keys = refinement.at("properties");
  CHECK(texts(keys.at("name").at("enum")) == names);
  CHECK(texts(keys.at("side").at("enum")) == sides);
}

TEST_CASE("the model schema has the reader's keys") {
  const JsonNode root = schema("model");
  const JsonNode& keys = root.at("properties");
  const std::string start = R"({"schema": "cablefit/model/1", )";
  const std::string joints = R"("joints": [{"link": {"inertia": {"J_link": 1}},
                                             "motor": {"inertia": {"J_motor": 1}}}], )";
  CHECK(properties(root) == known_to_model_reader(start + R"("?": 0})"));
  const Names joint_keys = known_to_model_reader(start + R"("joints": [{"?": 0}]})");
  CHECK(properties(keys.at("joints").at("items")) == joint_keys);
  CHECK(properties(keys.at("transmission")) ==
        known_to_model_reader(start + joints + R"("transmission": {"?": 0}})"));
  CHECK(properties(keys.at("transmission").at("properties").at("cables").at("items")) ==
        known_to_model_reader(start + joints +
                              R"("transmission": {"cables": [{"name": "1", "?": 0}]}})"));
  CHECK(properties(root.at("$defs").at("parameter").at("oneOf").items.at(1)) ==
        known_to_model_reader(start + R"("joints": [{"link": {"inertia": {"J_link": {"?": 0}}},
                                                     "motor": {}}]})"));
}

}  // namespace
