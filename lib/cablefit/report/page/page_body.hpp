// A document as the body of its HTML page: everything but the plots, which the page's script draws
// into the places that stand here.
#pragma once

#include <string>

#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// So many figures are shown at once; the others are folded.
inline constexpr std::size_t kMostShownFigures = 20;

/// Plain text.
std::string page_title(const Document& document);

/// Every text of the document escaped.
std::string page_body(const Document& document);

}  // namespace cablefit
