// Every cell of a campaign fitted, and its limits judged. What a cell's fit found is kept in a file
// named by the content of everything it was made from (cell_file.hpp), so that a run that was
// killed, or comes again after a log was added, fits only what is not there yet.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cablefit/campaign/campaign.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Name of the gate of a cell that could not be fitted.
inline constexpr const char* kFittedGate = "fitted";

/// One limit applied to one cell.
struct Gate {
  std::string name;  ///< "rsd_percent f_v", "torque_error motor", "drift J_link", "new_effect"
  std::string cell;
  double limit = 0;
  double value = 0;  ///< NaN: could not be computed, which fails
  bool passed = false;
  std::string text;  ///< one line for people
};

/// An effect that `refine` named.
struct CellEffect {
  std::string name, side;
  double gain = 0, p_value = 1;  ///< see RefineEvidence
  double torque_rms = 0;         ///< N m, what it carries where it acts
  std::vector<std::string> rivals;
};

/// What `refine` says of a cell.
struct CellRefine {
  std::string verdict;  ///< as in cablefit/refine/1; empty: see `error`
  std::string reason;   ///< one sentence
  std::vector<CellEffect> effects;
  GapStory torque, simulation;
  std::string next_experiment;
  std::string error;  ///< why there is no verdict
};

/// What the fit of a cell found, all that its file keeps.
struct CellResults {
  std::optional<ElasticResult> elastic;
  std::optional<DynamicResult> dynamic;
  std::optional<CellRefine> refine;
};

struct BatchCell : CellResults {
  std::string name, robot, preload, date;  ///< as in the campaign
  std::string error;                       ///< why it could not be fitted; empty: it was
  int exit_code = 0;                       ///< of that error
};

struct BatchResult {
  std::string campaign_path, campaign_name;
  std::vector<BatchCell> cells;
  std::vector<Gate> gates;
  std::vector<std::string> warnings;
  std::size_t n_kept = 0;  ///< cells that were there already

  /// All cells' results side by side, for Tables 1 and 2; preloads are called by their cell.
  ElasticResult all_elastic() const;
  DynamicResult all_dynamic() const;
};

/// How far a batch is.
struct BatchProgress {
  std::size_t n_cells = 0, n_done = 0, n_failed = 0;
  double seconds_left = -1;  ///< by the bytes of logs that are left; < 0: not known yet
};

struct BatchOptions {
  Reading reading;
  SampleOptions samples;   ///< its `threads` are for one cell
  ElasticOptions elastic;  ///< its `samples` and `preload` are replaced
  bool robust_sd = true;
  unsigned long seed = 1;  ///< of refine
  int jobs = 1;            ///< cells at a time
  std::string folder;      ///< of the cells' files; empty: none are kept
  std::function<void(const BatchProgress&)> progress = {};  ///< from any thread, one at a time
};

/// A cell that fails has the reason in its `error`; the others go on. The result does not depend on
/// the number of jobs, nor on which cells existed already.
BatchResult run_batch(const Campaign& campaign, const BatchOptions& options);

/// The one cell of that name: fitted unless its file exists. Throws Error(usage) for an unknown
/// name; other errors are in the cell's `error`.
BatchCell run_cell(const Campaign& campaign, const std::string& name, const BatchOptions& options);

/// The baseline of a drift limit is there and a batch result. Throws Error(input); before any log
/// is read, so that a mistake in it does not wait for them.
void check_baseline(const Campaign& campaign);

/// The gates of a campaign, on the model selected by stage 1's materiality rule (the richest one of
/// the campaign otherwise). Relative limits apply to parameters with a physical lower bound: for an
/// offset zero is the ideal value, and a percentage of it says nothing. Drift is against the cell
/// of the baseline with the same name, else the latest one of the same robot and preload. Throws
/// Error(input) for a bad baseline.
std::vector<Gate> judge(const Campaign& campaign, const std::vector<BatchCell>& cells);

}  // namespace cablefit
