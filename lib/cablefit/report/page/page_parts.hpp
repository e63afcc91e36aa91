// What the HTML page is made of, embedded in the library when it is built: page/ and plotly.js.
#pragma once

#include <string_view>

namespace cablefit::page_parts {

/// False when the library was built with CABLEFIT_PAGE=OFF; all parts are empty then.
bool built_in();

std::string_view html();    ///< page.html, with places for the other parts
std::string_view style();   ///< page.css
std::string_view script();  ///< page.js
std::string_view plotly();  ///< plotly-basic.min.js with its licence

}  // namespace cablefit::page_parts
