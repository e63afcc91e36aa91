// A log from memory: columns with the names and units that a log file would have.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// One column, one value per row; it is copied.
struct MemoryColumn {
  std::string name;  ///< as in a header: "t", "q", "theta [deg]", or a name in the rig's "columns"
  std::span<const double> values;
};

/// A log of one part, blocked when q does not move, else moving. `name` replaces the file name in
/// messages. Without a column t: `rate` in Hz. The preload is the rig's, else "default". Throws
/// Error(input) as plan_log() and survey_log(), and for columns of different lengths, fewer than 8
/// rows and values that are not finite.
LogSurvey survey_memory(const std::string& name, std::span<const MemoryColumn> columns,
                        const Rig& rig, double rate = 0);

}  // namespace cablefit
