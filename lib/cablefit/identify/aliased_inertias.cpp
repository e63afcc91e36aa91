#include "cablefit/identify/aliased_inertias.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/rows/scaled_settings.hpp"
#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/identify/preload_records.hpp"

namespace cablefit {
namespace {

constexpr double kOtherCutoff = 0.5;
constexpr double kNotSmall = 0.5;  // of the sd
constexpr double kNyquist = 0.5;   // of the sample rate

/// Settings are chosen by a resonance only where it is below half of the rate.
bool is_aliased(const PreloadFacts& preload) {
  return preload.has_moving && preload.resonance == 0;
}

/// The linear parameters with half the cut-off in the aliased preloads, l_o and weights as found.
Eigen::VectorXd fitted_with_half(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                 const JointFit& fit, const JudgedPoint& judged,
                                 const std::vector<PreloadFacts>& facts) {
  JointFit other = fit;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) {
    other.known[j].clear();
    if (!is_aliased(facts[j])) continue;
    const MovingJob moving(logs, options, fit, judged, j, facts[j]);
    other.jobs[j].records.back() =
        moving_record_with(with_cutoff_scaled(moving.job, kOtherCutoff), facts[j]);
  }
  return evaluate(other, {judged.point.l_o}).front().solution.x;
}

}  // namespace

void widen_aliased_inertias(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                            const JointFit& fit, const JudgedPoint& judged,
                            std::vector<PreloadFacts>& facts, std::vector<Estimate>& estimates) {
  const auto slow = std::find_if(facts.begin(), facts.end(), is_aliased);
  if (slow == facts.end()) return;
  const Eigen::VectorXd there = fitted_with_half(logs, options, fit, judged, facts);
  for (Eigen::Index k = 0; k < fit.layout.n_linear; ++k) {
    const auto at = static_cast<std::size_t>(k);
    Estimate& e = estimates[at];
    if (!fit.layout.parameters[at].inertia || !e.not_identifiable.empty() || !(e.sd > 0)) continue;
    const double moved = there(k) - judged.point.solution.x(k);
    if (std::abs(moved) > kNotSmall * e.sd)
      slow->warnings.push_back(fmt::format(
          "no free resonance under load below half of the sample rate, {:.4g} Hz: {} moves by "
          "{:.2g} % with half the cut-off, which is part of its sd; record faster",
          kNyquist * slow->rate, e.name, 100 * std::abs(moved / e.value)));
    widen_interval(e, std::hypot(1, moved / e.sd));
  }
}

}  // namespace cablefit
