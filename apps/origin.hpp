// What a report says of how it was made.
#pragma once

#include <string>
#include <vector>

#include "cablefit/report/parts/document.hpp"

namespace cablefit::apps {

/// As main() got them, without the program itself.
void remember_command(const std::vector<std::string>& arguments);

/// The day (UTC; SOURCE_DATE_EPOCH where it is set, as reproducible builds want it) and the
/// command. Without --threads, which no result depends on.
Origin origin();

}  // namespace cablefit::apps
