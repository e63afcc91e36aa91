// Campaign and rig files to begin with, with comments that say what else there is.
#pragma once

#include <string>

#include "cablefit/campaign/plan/found_logs.hpp"

namespace cablefit {

/// A cell needs a blocked log; those without are left out, as a comment.
bool is_complete(const FoundCell& cell);

/// cablefit/campaign/1 with comments. `name`: of the campaign.
std::string campaign_template(const std::string& name, const FoundLogs& found);

/// cablefit/rig/1 with comments.
std::string rig_template(const FolderWithoutRig& folder);

}  // namespace cablefit
