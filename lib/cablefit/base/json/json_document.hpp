// JSON (comments allowed) that remembers where each value stood, so that a wrong key or value in a
// rig, model, campaign or result file is reported as file:line:column. nlohmann-json does the
// parsing, inside json_document.cpp only.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/error.hpp"

namespace cablefit {

struct JsonMember;

class JsonNode {
 public:
  enum class Kind { null, boolean, number, string, array, object };
  using Member = JsonMember;

  Kind kind = Kind::null;
  bool boolean_value = false;
  double number_value = 0;
  std::string string_value;
  std::vector<JsonNode> items;  ///< of an array
  std::vector<Member> members;  ///< of an object, in the order of the file
  Place place;                  ///< of the value
  std::string path;             ///< "joints[0].name", for messages; its beginning may be cut off

  bool is_null() const { return kind == Kind::null; }
  bool is_object() const { return kind == Kind::object; }
  bool is_array() const { return kind == Kind::array; }
  bool is_number() const { return kind == Kind::number; }
  bool is_string() const { return kind == Kind::string; }

  /// The member of that name, or nullptr. Throws when this is no object.
  const JsonNode* find(std::string_view key) const;
  /// The member of that name; throws "missing key" with the place of the object.
  const JsonNode& at(std::string_view key) const;
  /// Typed reads; throw with the place and what was expected. Numbers are finite.
  double number() const;
  double positive() const;
  bool boolean() const;
  const std::string& text() const;
  std::vector<double> numbers() const;
  std::vector<std::string> texts() const;
  /// Throws when the object holds a key not in `keys`: "unknown key 'x'; did you mean 'y'?".
  void allow_only(std::initializer_list<std::string_view> keys) const;
  /// An input error at this value.
  Error error(const std::string& what, const std::string& hint) const;
};

/// A key and its value. No std::pair, which clang 14 cannot make of a class that holds it.
struct JsonMember {
  std::string first;
  JsonNode second;
};

/// Reads a file. Throws Error(input) for a missing file, bad JSON (line and column), duplicate
/// keys, more than 64 levels, more than 400000 values or more than `max_bytes`: what people and
/// cablefit write is far from these, and memory stays bounded.
JsonNode read_json_file(const std::string& path, std::size_t max_bytes = 16u << 20);
/// Same from text; `name` stands for the file in messages.
JsonNode parse_json(std::string_view text, const std::string& name);

}  // namespace cablefit
