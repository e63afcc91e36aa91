// The cells of a campaign file. Internal to campaign/.
#pragma once

#include <vector>

#include "cablefit/campaign/campaign.hpp"

namespace cablefit {

/// A path of a campaign file: relative ones are relative to it.
std::string beside(const std::string& campaign, const std::string& path);

/// The files that the path or pattern of `node` matches, sorted, at least one. Throws Error(input).
std::vector<std::string> matches(const JsonNode& node, const FindFiles& find_files);

/// All cells of the array `node`, with their names. Throws Error(input) as read_campaign().
std::vector<CampaignCell> read_cells(const JsonNode& node, const FindFiles& find_files);

}  // namespace cablefit
