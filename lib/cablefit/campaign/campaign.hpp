// The campaign file (cablefit/campaign/1): which logs belong to which preload of which rig, what to
// fit and what must hold.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cablefit {

/// Logs of a cell that `refine` looks at. Without `train` the cell's moving logs; without `test`
/// the last third of each is held out.
struct CampaignRefine {
  std::vector<std::string> train, test;
  std::size_t n_draws = 24;  ///< simulated data sets, see RefineOptions
};

/// One preload of one rig at one date. Paths are as found: relative ones relative to the campaign
/// file's folder, patterns ("low/moving*.csv") expanded and sorted.
struct CampaignCell {
  std::string name;   ///< no two cells have the same
  std::string robot;  ///< which one of several; may be empty
  std::string date;   ///< ISO 8601, "2026-03-14" or "2026-03-14T09:30"; may be empty
  std::string rig;    ///< empty: rig.json beside the logs, else the default rig
  std::string preload;
  std::vector<std::string> blocked, moving, validation;
  std::optional<CampaignRefine> refine;
};

struct CampaignLimits {
  std::optional<double> rsd_percent;   ///< largest relative sd of a physical parameter
  std::optional<double> torque_error;  ///< largest rms of an equation's residual, N m
  std::string drift_baseline;          ///< an earlier batch result; empty: no drift gate
  double drift_percent = 0;
  bool new_effect = true;  ///< whether `refine` may name one
};

struct Campaign {
  std::string path, name;
  std::vector<CampaignCell> cells;
  std::vector<std::string> models = {"linear", "poly"};
  std::string estimator = "auto";
  /// Fitted in stage 2 beside the paper's, by name: "stribeck[motor]"; of model poly.
  std::vector<std::string> effects = {};
  CampaignLimits limits;
};

/// Throws Error(input) at file:line:column: unknown keys, no cells, two cells of one name, a
/// pattern without a match, an unknown effect, a log twice in a cell. A cell without a name is
/// called by its preload, where several have that preload "robot, preload, date".
Campaign read_campaign(const std::string& path);

/// The files that match a pattern, sorted.
using FindFiles = std::function<std::vector<std::string>(const std::string& pattern)>;
class JsonNode;
/// The same from a document that is read already, whatever estimator it names.
Campaign parse_campaign(const JsonNode& root, const FindFiles& find_files);

}  // namespace cablefit
