// The trace of recursive least squares as CSV.
#pragma once

#include <string>

#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// rows,record,NAME,sd NAME,...; empty cells where nothing is known yet.
std::string trace_csv(const RecursiveTrace& trace);

}  // namespace cablefit
