// Stage 1 with initial elongations that nobody knows: several preloads of the same cables together.
#pragma once

#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// Some rig of the logs says "initial_elongation": "search".
bool wants_search(std::span<const LogSurvey> logs);
/// Some rig of the logs searches a motor radius.
bool searches_radius(std::span<const LogSurvey> logs);

/// Stage 1 of blocked logs with l_o and searched motor radii from the joint fit of all preloads:
/// the polynomial fit of each has the shared coefficients, whose covariance carries the uncertainty
/// of both, and l_o and r_m themselves. `search_all`: every l_o, whatever the rig files say. Throws
/// what identify() and fit_elastic() throw, and Error(not_identifiable) where the logs do not
/// determine an l_o or r_m.
ElasticResult fit_elastic_with_search(std::span<const LogSurvey> logs,
                                      const ElasticOptions& options, bool search_all);

}  // namespace cablefit
