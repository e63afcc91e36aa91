// Tables of a document as HTML.
#pragma once

#include <string>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// With its title above and its notes below.
std::string table_html(const Table& table);

/// Choices: where, what, and why.
std::string decisions_html(const std::vector<DecisionLine>& decisions);

/// A word on the colour of its tone.
std::string badge_html(const std::string& text, Tone tone);

}  // namespace cablefit
