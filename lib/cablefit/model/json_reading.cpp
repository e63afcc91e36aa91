#include "cablefit/model/json_reading.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {

void fail_unknown(const JsonNode& node, std::string_view kind, std::string_view name,
                  std::span<const std::string_view> known) {
  throw node.error(fmt::format("unknown {} {}", kind, in_quotes(name)), suggestion(name, known));
}

std::vector<double> n_numbers(const JsonNode& node, int n) {
  std::vector<double> values =
      node.is_array() ? node.numbers() : std::vector<double>{node.number()};
  if (values.size() != static_cast<std::size_t>(n)) {
    throw node.error(fmt::format("{} number(s), expected {}", values.size(), n),
                     "give one per joint");
  }
  return values;
}

double not_negative(const JsonNode& node) {
  const double value = node.number();
  if (value < 0) throw node.error(fmt::format("{} is negative", value), "expected 0 or more");
  return value;
}

std::string text_or(const JsonNode& object, std::string_view key, std::string_view otherwise) {
  const JsonNode* node = object.find(key);
  return node ? node->text() : std::string(otherwise);
}

double number_or(const JsonNode& object, std::string_view key, double otherwise) {
  const JsonNode* node = object.find(key);
  return node ? node->number() : otherwise;
}

std::string unique_name(const JsonNode& object, const std::vector<std::string>& taken) {
  const JsonNode& node = object.at("name");
  const std::string& name = node.text();
  if (name.empty()) throw node.error("empty name", "give it a name, e.g. \"1\"");
  if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
    throw node.error(fmt::format("{} appears twice", in_quotes(name)), "give each its own name");
  }
  return name;
}

void check_schema(const JsonNode& object, std::string_view schema) {
  const JsonNode* node = object.find("schema");
  if (node && node->text() != schema) {
    throw node->error(fmt::format("schema {}", in_quotes(node->text())),
                      fmt::format("expected '{}'", schema));
  }
}

const std::vector<JsonNode::Member>& members_of(const JsonNode& node) {
  (void)node.find("");  // throws when this is no object
  return node.members;
}

const std::vector<JsonNode>& some_items(const JsonNode& node) {
  if (!node.is_array() || node.items.empty()) {
    throw node.error("expected a list with at least one item", "write [{...}, ...]");
  }
  return node.items;
}

Unit unit_at(const JsonNode& node, std::string_view text) {
  return at_place_of(node, [&] { return parse_unit(text); });
}

}  // namespace cablefit
