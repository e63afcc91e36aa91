// Logs that a command takes by several options.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace cablefit::apps {

struct GivenLogs {
  std::string option;  ///< "--test"
  const std::vector<std::string>& paths;
};

/// Throws Error(usage) for a log in two places, by whatever path: its rows would count double, or
/// judge what was made from it.
void require_distinct(std::span<const GivenLogs> given);

}  // namespace cablefit::apps
