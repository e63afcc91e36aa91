// What every step of refine works with, and where the workflow stands. Internal to refine/.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "cablefit/refine/base_draws.hpp"
#include "cablefit/refine/confirm.hpp"
#include "cablefit/refine/levels.hpp"
#include "cablefit/refine/refine.hpp"
#include "cablefit/refine/search.hpp"
#include "cablefit/refine/shape_moves.hpp"

namespace cablefit {

/// What every step needs.
struct RefineBench {
  const RefineOptions& options;
  PartFilter wanted = {};
  bool elastic_only = false;
  ScanSettings scan = {};
  std::vector<LogSurvey> all = {};   ///< blocked, training, test: by Stretch::log
  std::vector<LogSurvey> logs = {};  ///< blocked, then training
  /// Simulated for the last word; of the training logs, when there are no others, the share held
  /// back.
  std::vector<LogSurvey> unseen = {};
  Smoothing smoothing = {};
  double held_back = 0;  ///< share of every training log that is the unseen data
  KindLevels floor{}, test_floor{};
  ValueChange base_bias = {};  ///< of the base fit, see fit_bias.hpp
  SimulatedGap simulation_floor = {};
  std::optional<BaseDraws> null = {};
  BaseFit noise = {};                ///< one of its draws without an effect
  std::vector<NullDraw> draws = {};  ///< of searches; none until something is worth them
  KindLevels white_floor{};          ///< of whitened training rows, see whitened_look.hpp
  std::vector<NullDraw> white_draws = {};
  bool is_disturbed = false;  ///< see need_disturbance
  Search first_search = {};   ///< on the base alone
  std::size_t n_kept = 0;     ///< effects that the models had, the first that designs hold
  Design bare = {};           ///< the base without these, where there are any

  /// Of training rows as they are fitted.
  const KindLevels& floor_of(const Design& design) const {
    return design.whitening.is_needed() ? white_floor : floor;
  }
  const std::vector<NullDraw>& draws_of(const Design& design) const {
    return design.whitening.is_needed() ? white_draws : draws;
  }
  /// N m of gaps over all equations, whose rows are weighted so that each has the motor's floor (of
  /// blocked logs alone theirs): of training and of unseen rows.
  double unit() const { return floor[static_cast<std::size_t>(RowKind::motor)]; }
  double unseen_unit() const { return test_floor[static_cast<std::size_t>(RowKind::motor)]; }
  /// rho of the training rows as they are, whichever way they were fitted.
  double rho(const Design& design, const BlockFit& fit) const;
  /// Of these models and the unseen logs.
  SimulatedGap simulated(std::span<const Model> models) const;
  /// Share of the time of every unseen log that neither chose nor fitted.
  double compared() const { return held_back > 0 ? held_back : 1; }
};

/// Where the workflow stands.
struct RefineState {
  Design design, test;  ///< training and unseen rows, with the same columns
  Eigen::VectorXd x;
  KindLevels levels{};
  double rho = 0;  ///< training rows
  RowGap unseen;
  SimulatedGap simulated;
  /// Of a whitened state: what the state that it was made of leaves with its best values.
  std::optional<SimulatedGap> simulated_before = {};
};

/// The base fit, floors and unseen rows. Throws Error(input) without a long enough stretch.
RefineState prepare(RefineBench& bench, std::span<const Model> models, const RefineLogs& logs,
                    RefineResult& result);

/// Gives simulated data sets what even the best candidate of a search on the base leaves; done
/// once.
void need_disturbance(RefineBench& bench, const RefineState& state, const Search& found);

/// Simulated data sets are searched only once something is worth it.
void need_draws(RefineBench& bench, const RefineState& state, const Search& found,
                const RefineOptions& options);

void tell(const RefineOptions& options, std::string_view what, double share);

}  // namespace cablefit
