// What a command is called with.
#pragma once

#include <string>
#include <vector>

namespace cablefit::apps {

using Arguments = std::vector<std::string>;  ///< of the command, without its own name

}  // namespace cablefit::apps
