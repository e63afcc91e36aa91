// Texts as HTML: what comes from a log has no meaning to the browser, units and symbols look as in
// print.
#pragma once

#include <string>
#include <string_view>

namespace cablefit {

/// Printable UTF-8 without < > & and quotes: for the content of an element and for an attribute in
/// double quotes. Names in a right-to-left script do not reorder the text beside them.
std::string html_text(std::string_view text);

/// "rad^2" as "rad²". Plain text, as all below: not yet escaped.
std::string pretty_unit(std::string_view text);
/// "theta - q" as "θ − q", "tau" as "τ".
std::string pretty_symbols(std::string_view text);
/// A cell of a table: "1.0 +- 0.1" as "1.0 ± 0.1", "1 -> 2" as "1 → 2", and powers.
std::string pretty_cell(std::string_view text);

}  // namespace cablefit
