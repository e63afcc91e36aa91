// Colour on a terminal: warnings yellow, failures red.
#pragma once

#include <string>

namespace cablefit::apps {

/// Standard output is a terminal that shows colour, and NO_COLOR (no-color.org) is not set.
bool shows_colour();
/// The text with its warnings and failures marked.
std::string coloured(const std::string& text);

}  // namespace cablefit::apps
