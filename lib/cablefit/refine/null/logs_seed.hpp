// A seed that goes with the logs. Internal to refine/.
#pragma once

#include <cstdint>
#include <span>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Of the random numbers of data sets simulated like these logs: another for other numbers in the
/// logs, so that the p-values of several sets of logs are independent of each other. The same for
/// the same rows, whatever the order of the logs and the name and format of a file.
std::uint64_t seed_for(std::span<const LogSurvey> logs, std::uint64_t seed);

}  // namespace cablefit
