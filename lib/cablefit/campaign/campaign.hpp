// The campaign file (cablefit/campaign/1): which logs belong to which preload of which rig, what to
// fit and what must hold.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cablefit {

/// One preload of one rig. Paths are as found: relative ones relative to the campaign file's
/// folder, patterns ("low/moving*.csv") expanded and sorted.
struct CampaignCell {
  std::string rig;  ///< empty: rig.json beside the logs, else the default rig
  std::string preload;
  std::vector<std::string> blocked, moving, validation;
};

struct CampaignLimits {
  std::optional<double> rsd_percent;   ///< largest relative sd of a physical parameter
  std::optional<double> torque_error;  ///< largest rms of an equation's residual, N m
  std::string drift_baseline;          ///< an earlier batch result; empty: no drift gate
  double drift_percent = 0;
};

struct Campaign {
  std::string path, name;
  std::vector<CampaignCell> cells;
  std::vector<std::string> models = {"linear", "poly"};
  std::string estimator = "auto";
  CampaignLimits limits;
};

/// Throws Error(input) at file:line:column: unknown keys, no cells, two cells of one preload and
/// rig, a pattern without a match.
Campaign read_campaign(const std::string& path);

/// The files that match a pattern, sorted.
using FindFiles = std::function<std::vector<std::string>(const std::string& pattern)>;
class JsonNode;
/// The same from a document that is read already.
Campaign parse_campaign(const JsonNode& root, const FindFiles& find_files);

}  // namespace cablefit
