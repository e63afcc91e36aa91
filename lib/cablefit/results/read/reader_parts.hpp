// What the readers of result files share. A key that is missing leaves what it would say at its
// default: old files have fewer. Internal to results/.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/base/json/json_document.hpp"
#include "cablefit/base/parameter.hpp"
#include "cablefit/samples/plan/input_file.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit::result_file {

/// Throws where "schema" is another; `what`: "a stage-1 result", `command`: what writes it.
void require_schema(const JsonNode& root, std::string_view schema, std::string_view what,
                    std::string_view command);

/// NaN: null or missing.
double number_or_nan(const JsonNode& object, std::string_view key);
/// A list of such numbers.
std::vector<double> numbers_or_nan(const JsonNode& object, std::string_view key);
/// Empty: null or missing.
std::string text_or_none(const JsonNode& object, std::string_view key);
/// "linear_motion": true, false, "mixed"; missing: rotary.
Axes axes_at(const JsonNode& object);
bool flag_or(const JsonNode& object, std::string_view key, bool otherwise);
std::size_t count_or_zero(const JsonNode& object, std::string_view key);
std::vector<std::string> texts_or_none(const JsonNode& object, std::string_view key);
/// The list of that name, or an empty one.
const std::vector<JsonNode>& items_or_none(const JsonNode& object, std::string_view key);
/// The object of that name, or nullptr where it is null or missing.
const JsonNode* object_or_none(const JsonNode& object, std::string_view key);

/// An object of numbers or of texts, by name.
std::map<std::string, double> numbers_by_name(const JsonNode& object, std::string_view key);
std::map<std::string, std::string> texts_by_name(const JsonNode& object, std::string_view key);

std::vector<InputFile> read_inputs(const JsonNode& root);
std::vector<Decision> read_decisions(const JsonNode& node);
RowCounts read_row_counts(const JsonNode& node);
WindowCounts read_window_counts(const JsonNode& node);

/// "parameters" or "derived", in SI. Throws where one has neither a value nor the reason why it has
/// none.
std::vector<Estimate> read_estimates(const JsonNode& list);

}  // namespace cablefit::result_file
