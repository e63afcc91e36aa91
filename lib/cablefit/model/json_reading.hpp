// Small helpers for the readers of rig and model files.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/units.hpp"

namespace cablefit {

/// Runs `action`; an Error it throws without a place is thrown again with the place of `node`.
template <typename Action>
decltype(auto) at_place_of(const JsonNode& node, Action&& action) {
  try {
    return std::forward<Action>(action)();
  } catch (const Error& error) {
    throw Error(error.kind(), to_string(node.place) + ": " + error.what());
  }
}

/// The value that stands beside the node's text in `options`; any other text is an error.
template <typename T, std::size_t N>
T choose(const JsonNode& node, const std::array<std::pair<std::string_view, T>, N>& options);

/// Throws "unknown <kind> 'x'; did you mean 'y'?" at the node.
[[noreturn]] void fail_unknown(const JsonNode& node, std::string_view kind, std::string_view name,
                               std::span<const std::string_view> known);

/// A list of n numbers; a bare number counts as a list of one.
std::vector<double> n_numbers(const JsonNode& node, int n);

/// A number >= 0.
double not_negative(const JsonNode& node);

/// An optional member's text or number, or the default.
std::string text_or(const JsonNode& object, std::string_view key, std::string_view otherwise);
double number_or(const JsonNode& object, std::string_view key, double otherwise);

/// The "name" of an array item, not empty and not in `taken`.
std::string unique_name(const JsonNode& object, const std::vector<std::string>& taken);

/// The object must not call itself anything but `schema`; "schema" may be left out.
void check_schema(const JsonNode& object, std::string_view schema);

/// The members of an object.
const std::vector<JsonNode::Member>& members_of(const JsonNode& node);

/// An array with at least one item.
const std::vector<JsonNode>& some_items(const JsonNode& node);

/// Throws Error(input) at the node when the text is no unit.
Unit unit_at(const JsonNode& node, std::string_view text);

template <typename T, std::size_t N>
T choose(const JsonNode& node, const std::array<std::pair<std::string_view, T>, N>& options) {
  std::vector<std::string_view> known;
  for (const auto& [name, value] : options) {
    if (name == node.text()) return value;
    known.push_back(name);
  }
  fail_unknown(node, "value", node.text(), known);
}

}  // namespace cablefit
