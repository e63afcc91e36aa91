// Every cell of a campaign fitted, and its limits judged.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/campaign/campaign.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/elastic/elastic_fit.hpp"

namespace cablefit {

/// One limit applied to one cell.
struct Gate {
  std::string name;  ///< "rsd_percent f_v", "torque_error motor", "drift J_link"
  std::string cell;
  double limit = 0;
  double value = 0;  ///< NaN: could not be computed, which fails
  bool passed = false;
  std::string text;  ///< one line for people
};

struct BatchCell {
  std::string name;  ///< the preload
  std::optional<ElasticResult> elastic;
  std::optional<DynamicResult> dynamic;
  std::string error;  ///< why it could not be fitted; empty: it was
  int exit_code = 0;  ///< of that error
};

struct BatchResult {
  std::string campaign_path, campaign_name;
  std::vector<BatchCell> cells;
  std::vector<Gate> gates;

  /// All cells' results side by side, for Tables 1 and 2.
  ElasticResult all_elastic() const;
  DynamicResult all_dynamic() const;
};

struct BatchOptions {
  SampleOptions samples;
  ElasticOptions elastic;  ///< its `samples` and `preload` are replaced
  bool honest_sd = true;
  bool figures = false;  ///< of both stages, for reports with plots
};

/// A cell that fails is told in its `error`; the others go on.
BatchResult run_batch(const Campaign& campaign, const BatchOptions& options);

/// The baseline of a drift limit is there and a batch result. Throws Error(input); before any log
/// is read, so that a mistake in it does not wait for them.
void check_baseline(const Campaign& campaign);

/// The gates of a campaign, on the model selected by stage 1's materiality rule (the richest one of
/// the campaign otherwise). Relative limits apply to parameters with a physical lower bound: for an
/// offset zero is the ideal value, and a percentage of it says nothing. Throws Error(input) for a
/// bad baseline.
std::vector<Gate> judge(const Campaign& campaign, const std::vector<BatchCell>& cells);

}  // namespace cablefit
