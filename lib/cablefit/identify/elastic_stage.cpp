#include "cablefit/identify/elastic_stage.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"
#include "cablefit/identify/elastic_search.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

const Rig& rig_of(std::span<const LogSurvey> logs, const std::string& preload) {
  return first_log_with(logs, [&](const PartSurvey& part) { return part.preload == preload; })
      .plan.rig;
}

std::string unit_of(const ElasticPreload& preload) { return torque_unit(preload.axes); }

/// Stage 1 of one preload.
struct Stage1 {
  ElasticPreload preload;
  ElongationCovariance elongations = {};
};

/// The preload fitted again with l_o looked for. Throws Error(not_identifiable) where there is
/// none.
Stage1 searched(std::span<const LogSurvey> logs, const ElasticOptions& options,
                const ElasticPreload& plain) {
  ElasticOptions own = options;
  own.preload = plain.name;
  ElasticResult found = fit_elastic_with_search(logs, own, true);
  return {std::move(found.preloads.at(0)), std::move(found.elongations)};
}

bool is_better(const Stage1& found, const ElasticPreload& plain) {
  return found.preload.fits.back().rms_error <= (1 - kSearchGain) * plain.fits.back().rms_error;
}

Stage1 with_reason(Stage1 found, const ElasticPreload& plain, std::string_view reason) {
  for (Decision& d : found.preload.decisions)
    if (d.name == "l_o")
      d.reason = fmt::format("{}; the residual of the cables goes from {:.3g} to {:.3g} {} rms",
                             reason, plain.fits.back().rms_error,
                             found.preload.fits.back().rms_error, unit_of(plain));
  return found;
}

/// With l_o looked for, where that explains the curve; else as it was, with the doubt.
Stage1 without_doubt(std::span<const LogSurvey> logs, const ElasticOptions& options,
                     ElasticPreload plain) {
  try {
    Stage1 found = searched(logs, options, plain);
    if (is_better(found, plain)) return with_reason(std::move(found), plain, plain.shape_doubt);
    plain.shape_doubt += fmt::format("; a search of l_o leaves the residual at {:.3g} {} rms",
                                     found.preload.fits.back().rms_error, unit_of(plain));
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    plain.shape_doubt += fmt::format("; a search of l_o found none ({})", error.what());
  }
  plain.warnings.push_back(fmt::format("{}: stage 2 gives no intervals", plain.shape_doubt));
  return {std::move(plain)};
}

/// Its stiffness falls by a tenth somewhere on the way to this stretch.
bool softens(const Cable& cable, double stretch) {
  constexpr int kSteps = 18;
  constexpr double kFall = 0.9, kReach = 0.9;  // beyond that a high order may swing
  double highest = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const double stiffness = cable.stiffness(stretch * std::max(1e-6, kReach * k / kSteps));
    if (stiffness < kFall * highest) return true;
    highest = std::max(highest, stiffness);
  }
  return false;
}

/// With l_o = 0 each of the two cables acts on its own side and becomes stiffer, if anything. Where
/// both seem to soften they may be taut together up to there, however far that is.
bool may_be_preloaded(const ElasticPreload& plain) {
  const Transmission& pair = plain.fits.back().transmission;
  const double stretch = std::min(-plain.deflection_low, plain.deflection_high);
  return pair.n_joints == 1 && pair.cables.size() == 2 && stretch > 0 &&
         std::all_of(pair.cables.begin(), pair.cables.end(), [&](const Cable& cable) {
           return cable.initial_elongation == 0 && !cable.coefficients.empty() &&
                  softens(cable, stretch);
         });
}

/// With l_o looked for, where that is better; else as it was.
Stage1 tried(std::span<const LogSurvey> logs, const ElasticOptions& options, ElasticPreload plain) {
  try {
    Stage1 found = searched(logs, options, plain);
    if (is_better(found, plain))
      return with_reason(std::move(found), plain, "both cables seem to soften with l_o = 0");
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
  }
  return {std::move(plain)};
}

}  // namespace

ElasticResult fit_elastic_stage(std::span<const LogSurvey> logs, const ElasticOptions& options,
                                ElongationMode mode) {
  const bool search_all = mode == ElongationMode::search;
  // With l_o "search" in a rig file, --l-o known is refused as without a searched radius.
  const bool is_known = mode == ElongationMode::known && wants_search(logs);
  if (search_all || (!is_known && (wants_search(logs) || searches_radius(logs))))
    return fit_elastic_with_search(logs, options, search_all);
  ElasticResult result = fit_elastic(logs, options);
  if (mode == ElongationMode::known || options.still || options.unconstrained ||
      !options.orders.empty() || options.offset)
    return result;
  for (ElasticPreload& preload : result.preloads) {
    if (rig_of(logs, preload.name).cables_given) continue;
    const bool is_doubted = !preload.shape_doubt.empty();
    if (!is_doubted && !may_be_preloaded(preload)) continue;
    Stage1 stage1 = is_doubted ? without_doubt(logs, options, std::move(preload))
                               : tried(logs, options, std::move(preload));
    preload = std::move(stage1.preload);
    add_independent(stage1.elongations, result.elongations);
  }
  return result;
}

}  // namespace cablefit
