#include "tests/report/schema.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

namespace cablefit::test {
namespace {

using nlohmann::json;

bool is_of_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number_integer();
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  throw std::runtime_error("unknown type " + type);
}

class Checker {
 public:
  explicit Checker(const json& root) : root_(root) {}

  void check(const json& value, const json& schema, const std::string& place) {
    require_known_keywords(schema);
    if (schema.contains("$ref")) {
      const std::string pointer = schema["$ref"].get<std::string>().substr(1);
      check(value, root_.at(json::json_pointer(pointer)), place);
    }
    expect(!schema.contains("const") || value == schema["const"], place, "not the constant");
    if (schema.contains("enum")) {
      const json& known = schema["enum"];
      expect(std::find(known.begin(), known.end(), value) != known.end(), place,
             "not among " + known.dump());
    }
    if (schema.contains("type")) check_type(value, schema["type"], place);
    if (value.is_object()) check_members(value, schema, place);
    if (value.is_array()) check_items(value, schema, place);
    if (value.is_string()) check_size(value.get<std::string>().size(), schema, "Length", place);
    if (value.is_number() && schema.contains("minimum")) {
      expect(value >= schema["minimum"], place, "too small");
    }
  }
  std::string errors() const { return errors_; }

 private:
  static void require_known_keywords(const json& schema) {
    static const std::set<std::string> kKnown = {
        "$schema", "$id",      "$defs",    "$ref",      "title",      "description",
        "type",    "const",    "enum",     "required",  "properties", "additionalProperties",
        "items",   "minItems", "maxItems", "minLength", "maxLength",  "minimum"};
    for (const auto& [key, ignored] : schema.items()) {
      if (kKnown.count(key) == 0) throw std::runtime_error("unknown keyword " + key);
    }
  }
  void check_type(const json& value, const json& types, const std::string& place) {
    bool fits = false;
    for (const json& type : types.is_array() ? types : json::array({types})) {
      fits |= is_of_type(value, type.get<std::string>());
    }
    expect(fits, place, "wrong type, not " + types.dump());
  }
  void check_members(const json& value, const json& schema, const std::string& place) {
    for (const json& key : schema.value("required", json::array())) {
      expect(value.contains(key.get<std::string>()), place, key.get<std::string>() + " is missing");
    }
    const json properties = schema.value("properties", json::object());
    const json others = schema.value("additionalProperties", json(true));
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key)) {
        check(member, properties[key], place + "/" + key);
      } else if (others.is_object()) {
        check(member, others, place + "/" + key);
      } else {
        expect(others.get<bool>(), place, key + " is not allowed");
      }
    }
  }
  void check_items(const json& value, const json& schema, const std::string& place) {
    check_size(value.size(), schema, "Items", place);
    if (!schema.contains("items")) return;
    for (std::size_t k = 0; k < value.size(); ++k) {
      check(value[k], schema["items"], place + "/" + std::to_string(k));
    }
  }
  void check_size(std::size_t size, const json& schema, const std::string& what,
                  const std::string& place) {
    expect(size >= schema.value("min" + what, std::size_t{0}), place, "too short");
    expect(size <= schema.value("max" + what, size), place, "too long");
  }
  void expect(bool holds, const std::string& place, const std::string& what) {
    if (!holds) errors_ += place + ": " + what + "\n";
  }

  const json& root_;
  std::string errors_;
};

}  // namespace

std::string schema_errors(const std::string& name, const std::string& text) {
  std::ifstream file(CABLEFIT_DATA "/schema/" + name + ".schema.json");
  const json schema = json::parse(file);
  Checker checker(schema);
  checker.check(json::parse(text), schema, "");
  return checker.errors();
}

}  // namespace cablefit::test
