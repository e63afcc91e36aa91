// The figures of a document as the JSON that the page's script draws.
#pragma once

#include <string>
#include <vector>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Within <script type="application/json">: every text printable UTF-8, and < > & and the line
/// separators of JavaScript escaped, so that nothing from a log can end the element.
std::string page_data(const Document& document);

/// Base64 of the values as little-endian 32-bit floats, relative to `base`. A plot needs no more
/// digits, and six characters a value keep pages small. NaN stays NaN.
std::string packed(const std::vector<double>& values, double base);

}  // namespace cablefit
