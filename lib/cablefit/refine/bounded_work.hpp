// What a search costs is bounded before it begins.
#pragma once

#include "cablefit/refine/refine_options.hpp"

namespace cablefit {

/// Every draw simulates the logs at 10 kHz, whatever their rate: slow logs cost more a row than
/// they show. Throws Error(input) for one that is both slow and long.
void require_bounded_work(const RefineLogs& logs);

}  // namespace cablefit
