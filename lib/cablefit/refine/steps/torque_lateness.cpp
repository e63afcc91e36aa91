#include "cablefit/refine/steps/torque_lateness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/rows/stretches.hpp"

namespace cablefit {
namespace {

const Effect& delay_row() {
  const auto rows = candidate_effects();
  return *std::find_if(rows.begin(), rows.end(),
                       [](const Effect& row) { return row.delays_torque; });
}

}  // namespace

std::optional<TorqueLateness> fit_torque_lateness(std::span<const Model> models,
                                                  std::span<const LogSurvey> logs, double row) {
  const double block_seconds = ScanSettings{}.block_seconds;
  try {
    std::vector<Stretch> stretches =
        read_stretches(logs, models, [](const PartSurvey& /*part*/) { return true; });
    if (stretches.empty() || is_blocked_only(stretches)) return std::nullopt;
    const Smoothing smoothing = smoothing_for(finest_period(stretches, false));
    const BaseFit base =
        fit_base(make_design(models, std::move(stretches), smoothing), block_seconds, nullptr);
    const Design with = with_variant(base.design, {&delay_row(), {}}, base.fit.x);
    const auto fit = fit_blocks(block_grams(with, block_seconds), base.levels, false);
    if (!fit) return std::nullopt;
    const Eigen::Index last = fit->x.size() - 1;
    return TorqueLateness{torque_lateness(models.front().rig, row) * row + fit->x(last),
                          std::sqrt(std::max(0.0, fit->covariance(last, last)))};
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    return std::nullopt;
  }
}

}  // namespace cablefit
