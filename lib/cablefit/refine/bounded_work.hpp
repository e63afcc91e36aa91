// Limits the cost of a search before it begins.
#pragma once

#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

/// Every draw simulates the logs at 10 kHz for any rate, so slow logs cost more per row. Throws
/// Error(input) for a log that is both slow and long.
void require_bounded_work(const RefineLogs& logs);

}  // namespace cablefit
