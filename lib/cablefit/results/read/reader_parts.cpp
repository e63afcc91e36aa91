#include "cablefit/results/read/reader_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/file/parts.hpp"

namespace cablefit::result_file {
namespace {

/// The member, or nullptr where it is null or missing.
const JsonNode* given(const JsonNode& object, std::string_view key) {
  const JsonNode* node = object.find(key);
  return node == nullptr || node->is_null() ? nullptr : node;
}

template <typename Value, typename Read>
std::map<std::string, Value> by_name(const JsonNode& object, std::string_view key, Read read) {
  std::map<std::string, Value> values;
  if (const JsonNode* node = given(object, key))
    for (const JsonMember& member : node->members) values[member.first] = read(member);
  return values;
}

}  // namespace

void require_schema(const JsonNode& root, std::string_view schema, std::string_view what,
                    std::string_view command) {
  const JsonNode& node = root.at("schema");
  if (node.text() == schema) return;
  throw node.error(fmt::format("schema '{:.60}' is not {}", node.text(), what),
                   fmt::format("expected '{}', as `cablefit {}` writes it", schema, command));
}

double number_or_nan(const JsonNode& object, std::string_view key) {
  const JsonNode* node = given(object, key);
  return node == nullptr ? kNotKnown : node->number();
}

std::vector<double> numbers_or_nan(const JsonNode& object, std::string_view key) {
  std::vector<double> values;
  for (const JsonNode& item : items_or_none(object, key))
    values.push_back(item.is_null() ? kNotKnown : item.number());
  return values;
}

std::string text_or_none(const JsonNode& object, std::string_view key) {
  const JsonNode* node = given(object, key);
  return node == nullptr ? std::string() : node->text();
}

Axes axes_at(const JsonNode& object) {
  const JsonNode* node = given(object, "linear_motion");
  if (node == nullptr) return Axes::rotary;
  if (node->is_string()) return Axes::mixed;
  return node->boolean() ? Axes::linear : Axes::rotary;
}

bool flag_or(const JsonNode& object, std::string_view key, bool otherwise) {
  const JsonNode* node = given(object, key);
  return node == nullptr ? otherwise : node->boolean();
}

std::size_t count_or_zero(const JsonNode& object, std::string_view key) {
  const JsonNode* node = given(object, key);
  if (node == nullptr) return 0;
  const double value = node->number();
  if (value >= 0 && value == std::floor(value)) return static_cast<std::size_t>(value);
  throw node->error(fmt::format("{} is not a count", value), "write a whole number of rows");
}

std::vector<std::string> texts_or_none(const JsonNode& object, std::string_view key) {
  const JsonNode* node = given(object, key);
  return node == nullptr ? std::vector<std::string>{} : node->texts();
}

const std::vector<JsonNode>& items_or_none(const JsonNode& object, std::string_view key) {
  static const std::vector<JsonNode> kNothing;
  const JsonNode* list = object.find(key);
  return list == nullptr ? kNothing : list->items;
}

const JsonNode* object_or_none(const JsonNode& object, std::string_view key) {
  const JsonNode* node = given(object, key);
  return node != nullptr && node->is_object() ? node : nullptr;
}

std::map<std::string, double> numbers_by_name(const JsonNode& object, std::string_view key) {
  return by_name<double>(object, key, [](const JsonMember& member) {
    return member.second.is_null() ? kNotKnown : member.second.number();
  });
}

std::map<std::string, std::string> texts_by_name(const JsonNode& object, std::string_view key) {
  return by_name<std::string>(object, key,
                              [](const JsonMember& member) { return member.second.text(); });
}

std::vector<InputFile> read_inputs(const JsonNode& root) {
  std::vector<InputFile> inputs;
  for (const JsonNode& item : items_or_none(root, "inputs"))
    inputs.push_back(
        {item.at("path").text(), item.at("sha256").text(), count_or_zero(item, "rows")});
  return inputs;
}

std::vector<Decision> read_decisions(const JsonNode& node) {
  std::vector<Decision> decisions;
  for (const JsonNode& item : items_or_none(node, "decisions"))
    decisions.push_back(
        {item.at("name").text(), item.at("value").text(), item.at("reason").text()});
  return decisions;
}

RowCounts read_row_counts(const JsonNode& node) {
  return {count_or_zero(node, "rows_used"), count_or_zero(node, "rows_at_rest"),
          count_or_zero(node, "rows_not_used"), count_or_zero(node, "rows_at_edges")};
}

WindowCounts read_window_counts(const JsonNode& node) {
  return {count_or_zero(node, "rows_read"), count_or_zero(node, "rows_resampled"),
          count_or_zero(node, "rows_too_short"), count_or_zero(node, "segments")};
}

std::vector<Estimate> read_estimates(const JsonNode& list) {
  std::vector<Estimate> estimates;
  if (!list.is_array())
    throw list.error("not a list of parameters", "write it as [{\"name\": ...}]");
  for (const JsonNode& item : list.items) {
    const std::string name = item.at("name").text();
    const JsonNode* symbol = item.find("symbol");
    estimates.push_back(model_file::read_estimate(
        item, name, symbol == nullptr ? name : symbol->text(), text_or_none(item, "unit")));
  }
  return estimates;
}

}  // namespace cablefit::result_file
