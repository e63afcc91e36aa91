// Samples at standstill that --rest-speed 0 keeps: their torque lies anywhere in the friction band,
// so that the f_sm of a fit to them is too low.
#pragma once

#include "cablefit/elastic/models/candidates.hpp"

namespace cablefit {

/// Warns of them, with the f_sm of the samples in motion alone. `cables`: the fit that `preload`
/// ends with. One joint.
void note_standstill(const ElasticJob& job, const BlockedRows& rows, const ElasticCandidate& cables,
                     ElasticPreload& preload);

}  // namespace cablefit
