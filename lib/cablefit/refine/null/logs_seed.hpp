// A seed that depends on the logs. Internal to refine/.
#pragma once

#include <cstdint>
#include <span>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Seed for data sets simulated like these logs. Logs with other numbers have another seed, so that
/// the p-values of several sets of logs are independent. The order of the logs and the name and
/// format of a file do not change it.
std::uint64_t seed_for(std::span<const LogSurvey> logs, std::uint64_t seed);

}  // namespace cablefit
