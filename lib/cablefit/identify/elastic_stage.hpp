// Stage 1 as a user means it: with l_o as the rig file has it, or looked for where the curve says
// that it is wrong.
#pragma once

#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/identify/identify.hpp"

namespace cablefit {

/// fit_elastic(), or fit_elastic_with_search() where a rig file says "search", of l_o or of a motor
/// radius, or `mode` is `search`. `automatic`: also for each preload of one joint whose cables the
/// rig file does not give and whose curve is that of cables which are both taut at zero
/// (ElasticPreload::shape_doubt), or may be. Such a search is kept if the residual shrinks by
/// kSearchGain; else the doubt, if any, stays in the result. Throws what those throw.
ElasticResult fit_elastic_stage(std::span<const LogSurvey> logs, const ElasticOptions& options,
                                ElongationMode mode);

inline constexpr double kSearchGain = 0.1;

}  // namespace cablefit
