// Folders named by the day or week of a recording.
#pragma once

#include <optional>
#include <string>

namespace cablefit {

/// "2026-11-09" from a folder called 2026-11-09, 2026_11_09, 20261109 or 09.11.2026, and the Monday
/// of 2026-w46 or 2026w46 (ISO 8601 weeks). None: the name is no date.
std::optional<std::string> date_of_folder(const std::string& name);

}  // namespace cablefit
