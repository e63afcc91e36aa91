// Texts of results that name a cell's files, apart from where these files are: a campaign may be
// moved, or be called from another folder, and its finished cells stay good. Internal to campaign/.
#pragma once

#include <string>
#include <vector>

namespace cablefit {

/// Each of `paths` where it stands for itself in the text becomes its number between two bytes
/// \x01. What is no UTF-8 is made printable.
std::string portable_text(const std::string& text, const std::vector<std::string>& paths);

/// The reverse, with paths of today.
std::string text_here(const std::string& text, const std::vector<std::string>& paths);

}  // namespace cablefit
