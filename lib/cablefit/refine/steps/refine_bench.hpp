// Data that every step of refine uses, and the state of the workflow. Internal to refine/.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "cablefit/refine/null/base_draws.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/levels.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"
#include "cablefit/refine/search/search.hpp"
#include "cablefit/refine/verdict/confirm.hpp"

namespace cablefit {

/// Of the moving logs, where no logs are given to test by.
inline constexpr double kHeldOutShare = 1.0 / 3;

/// Data that every step needs.
struct RefineBench {
  const RefineOptions& options;
  PartFilter wanted = {};
  bool elastic_only = false;
  ScanSettings scan = {};
  std::vector<LogSurvey> all = {};   ///< blocked, training, test: by Stretch::log
  std::vector<LogSurvey> logs = {};  ///< blocked, then training
  /// Read once, when everything is decided. Without test logs: the share of the training logs that
  /// was held back.
  std::vector<LogSurvey> test_logs = {};
  std::vector<Stretch> test = {};  ///< of these
  double held_back = 0;            ///< share of every training log that is test data
  KindLevels floor{}, test_floor{};
  ValueChange base_bias = {};  ///< of the base fit, see fit_bias.hpp
  SimulatedGap simulation_floor = {};
  std::uint64_t seed = 0;  ///< of the first simulated data set; each later one adds 1
  std::optional<BaseDraws> null = {};
  BaseFit noise = {};        ///< one of its draws without an effect
  KindLevels draw_levels{};  ///< weights of the draws' searches: those of the first search
  /// Held-out error of a fit over its floor when no effect is missing: a little above 1.
  double held_out_unit = 1;
  std::vector<NullDraw> draws = {};  ///< of searches; only as many as were needed
  Search first_search = {};          ///< on the base alone
  std::size_t n_kept = 0;  ///< effects that the models had; they are the first ones in designs
  Design bare = {};        ///< the base without these; empty without kept effects

  /// N m of gaps over all equations, whose rows are weighted so that each has the motor's floor
  /// (with blocked logs alone: their floor). For training and for test rows.
  double unit() const { return floor[static_cast<std::size_t>(RowKind::motor)]; }
  double test_unit() const { return test_floor[static_cast<std::size_t>(RowKind::motor)]; }
  /// For these models and the test logs.
  SimulatedGap simulated(std::span<const Model> models) const;
  /// Share of the time of every test log that was not fitted.
  double compared() const { return held_back > 0 ? held_back : 1; }
};

/// The state of the workflow after a step.
struct RefineState {
  Design design;  ///< training rows
  Eigen::VectorXd x;
  KindLevels levels{};
  double rho = 0;         ///< training rows
  RowGap held_out;        ///< the same rows, each block predicted by the others, over held_out_unit
  bool is_joint = false;  ///< judged together with the effect before
};

/// States without an effect, with the first, with the first two, and so on.
using Chain = std::vector<RefineState>;

/// Fills in `rho` and `held_out` of a fitted state.
void judge(const RefineBench& bench, const BlockFit& fit, RefineState& state);

/// The base fit, floors and test rows. Throws Error(input) without a long enough stretch.
RefineState prepare(RefineBench& bench, std::span<const Model> models, const RefineLogs& logs,
                    RefineResult& result);

/// Searches some more simulated data sets. False: the requested number is reached. The first call
/// sets their weights and their disturbance: the residual of the best candidate of `found`.
bool draw_more(RefineBench& bench, const RefineState& state, const Search& found);

void report_progress(const RefineOptions& options, std::string_view what, double share);

}  // namespace cablefit
