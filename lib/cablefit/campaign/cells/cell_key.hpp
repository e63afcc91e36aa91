// What a cell's result depends on, and nothing else. Internal to campaign/.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cablefit/campaign/batch.hpp"

namespace cablefit {

struct CellKey {
  std::string key;                            ///< 64 hex digits
  std::vector<std::string> paths;             ///< of its logs and rigs, each once
  std::map<std::string, std::string> sha256;  ///< by path
};

/// SHA-256 of the contents and names (without folders) of the logs, of the rig file of each, of all
/// options that may change a result, and of the version. Reads all logs once. Throws Error(input)
/// when one cannot be read.
CellKey key_of(const Campaign& campaign, const CampaignCell& cell, const BatchOptions& options);

/// Whether results have plots, which cost disk: of small campaigns they are shown on one page.
bool with_figures(const Campaign& campaign);

}  // namespace cablefit
