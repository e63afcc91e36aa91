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

/// The preload fitted again with l_o looked for, where that explains the curve; else as it was.
ElasticPreload with_search(std::span<const LogSurvey> logs, const ElasticOptions& options,
                           ElasticPreload plain) {
  const double before = plain.fits.back().rms_error;
  ElasticOptions own = options;
  own.preload = plain.name;
  try {
    ElasticPreload found = fit_elastic_with_search(logs, own, true).preloads.at(0);
    const double after = found.fits.back().rms_error;
    if (after <= (1 - kSearchGain) * before) {
      for (Decision& d : found.decisions)
        if (d.name == "l_o")
          d.reason =
              fmt::format("{}; the residual of the cables goes from {:.3g} to {:.3g} {} rms",
                          plain.shape_doubt, before, after, plain.linear_motion ? "N" : "N m");
      return found;
    }
    plain.shape_doubt += fmt::format("; a search of l_o leaves the residual at {:.3g} {} rms",
                                     after, plain.linear_motion ? "N" : "N m");
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_identifiable) throw;
    plain.shape_doubt += fmt::format("; a search of l_o found none ({})", error.what());
  }
  plain.warnings.push_back(fmt::format("{}: stage 2 gives no intervals", plain.shape_doubt));
  return plain;
}

}  // namespace

ElasticResult fit_elastic_stage(std::span<const LogSurvey> logs, const ElasticOptions& options,
                                ElongationMode mode) {
  const bool search_all = mode == ElongationMode::search;
  if (search_all || (mode == ElongationMode::automatic && wants_search(logs)))
    return fit_elastic_with_search(logs, options, search_all);
  ElasticResult result = fit_elastic(logs, options);
  if (mode == ElongationMode::known || options.still || options.unconstrained ||
      !options.orders.empty() || options.offset)
    return result;
  for (ElasticPreload& preload : result.preloads)
    if (!preload.shape_doubt.empty() && !rig_of(logs, preload.name).cables_given)
      preload = with_search(logs, options, std::move(preload));
  return result;
}

}  // namespace cablefit
