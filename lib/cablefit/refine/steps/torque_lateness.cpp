#include "cablefit/refine/steps/torque_lateness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/rows/stretches.hpp"
#include "cablefit/refine/undetermined.hpp"

namespace cablefit {
namespace {

const Effect& delay_row() {
  const auto rows = candidate_effects();
  return *std::find_if(rows.begin(), rows.end(),
                       [](const Effect& row) { return row.delays_torque; });
}

/// The models' rows with the column of a delay behind the others.
struct DelayedRows {
  Design design;
  KindLevels levels;
};

/// Nothing where no link moves.
std::optional<DelayedRows> delayed_rows(std::span<const Model> models,
                                        std::span<const LogSurvey> logs) {
  std::vector<Stretch> stretches =
      read_stretches(logs, models, [](const PartSurvey& /*part*/) { return true; });
  if (stretches.empty() || is_blocked_only(stretches)) return std::nullopt;
  const Smoothing smoothing = smoothing_for(finest_period(stretches, false));
  const BaseFit base = fit_base(make_design(models, std::move(stretches), smoothing),
                                ScanSettings{}.block_seconds, nullptr);
  return DelayedRows{with_variant(base.design, {&delay_row(), {}}, base.fit.x), base.levels};
}

/// Splits the last column: one for moving rows, then one for blocked rows.
void split_last_column(Design& design) {
  for (std::size_t s = 0; s < design.rows.size(); ++s)
    for (KindRows& kind : design.rows[s].kinds) {
      const Eigen::Index last = kind.base.cols();
      kind.base.conservativeResize(Eigen::NoChange, last + 1);
      kind.base.col(last).setZero();
      if (design.stretches[s].blocked) kind.base.col(last).swap(kind.base.col(last - 1));
    }
}

std::optional<BlockFit> fit_of(const DelayedRows& rows) {
  return fit_blocks(block_grams(rows.design, ScanSettings{}.block_seconds), rows.levels, false);
}

/// By column `at`, beside what the rows assume already.
TorqueLateness lateness_at(Eigen::Index at, const BlockFit& fit, const Rig& rig, double row) {
  return {torque_lateness(rig, row) * row + fit.x(at),
          std::sqrt(std::max(0.0, fit.covariance(at, at)))};
}

}  // namespace

std::optional<TorqueLateness> fit_torque_lateness(std::span<const Model> models,
                                                  std::span<const LogSurvey> logs, double row) {
  return unless_undetermined([&]() -> std::optional<TorqueLateness> {
    const auto rows = delayed_rows(models, logs);
    const auto fit = rows ? fit_of(*rows) : std::nullopt;
    if (!fit) return std::nullopt;
    return lateness_at(fit->x.size() - 1, *fit, models.front().rig, row);
  });
}

std::optional<SplitLateness> fit_split_lateness(std::span<const Model> models,
                                                std::span<const LogSurvey> logs, double row,
                                                double blocked_row) {
  return unless_undetermined([&]() -> std::optional<SplitLateness> {
    auto rows = delayed_rows(models, logs);
    if (!rows) return std::nullopt;
    split_last_column(rows->design);
    const auto fit = fit_of(*rows);
    if (!fit) return std::nullopt;
    const Eigen::Index last = fit->x.size() - 1;
    const Rig& rig = models.front().rig;
    return SplitLateness{lateness_at(last - 1, *fit, rig, row),
                         lateness_at(last, *fit, rig, blocked_row)};
  });
}

}  // namespace cablefit
