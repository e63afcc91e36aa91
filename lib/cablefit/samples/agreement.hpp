// Logs that go into one fit must agree: one rate, one rig, one kind of load.
#pragma once

#include <span>
#include <string>

#include "cablefit/samples/row_stream.hpp"

namespace cablefit {

/// For the wanted parts, which are all of `preload`: sample rates within 1 % of each other (a
/// filter and a decimation mean the same in each), rig files of the same content, and a tau_load
/// column wherever the rig says that the load is one. Throws Error(input) naming the two logs.
void require_agreement(std::span<const LogSurvey> logs, const PartFilter& wanted,
                       const std::string& preload);

/// Samples per second, by the first wanted part.
double sample_rate(std::span<const LogSurvey> logs, const PartFilter& wanted);

}  // namespace cablefit
