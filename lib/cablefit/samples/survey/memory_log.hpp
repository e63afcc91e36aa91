// A log from memory: columns with the names and units that a log file would have.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// One column, one value per row; it is copied.
struct MemoryColumn {
  std::string name;  ///< as in a header: "t", "q", "theta [deg]", or as the rig's "columns" say
  std::span<const double> values;
};

/// The columns as one part of a log, blocked or moving by whether q moves. `name` stands for the
/// file in messages. Without a column t: `rate` in Hz. The preload is the rig's, else "default".
/// Throws Error(input) as plan_log() and survey_log(), for columns of different lengths, fewer than
/// 8 rows and values that are not finite.
LogSurvey survey_memory(const std::string& name, std::span<const MemoryColumn> columns,
                        const Rig& rig, double rate = 0);

}  // namespace cablefit
