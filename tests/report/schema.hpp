// A checker for the part of JSON Schema 2020-12 that data/schema/ uses: type, const, enum,
// required, properties, additionalProperties, items, minItems, maxItems, minLength, maxLength,
// minimum, $ref.
#pragma once

#include <string>

namespace cablefit::test {

/// Checks a text against data/schema/NAME.schema.json: "place: what" lines, empty when it fits.
/// Throws std::runtime_error for a keyword it does not know.
std::string schema_errors(const std::string& name, const std::string& text);

}  // namespace cablefit::test
