// Rows of an equation with all variables that residuals are tested against, stored for several
// passes. Internal to dynamic/.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/samples/rows/row_archive.hpp"

namespace cablefit {

/// A column after those of the equation.
struct JudgedVariable {
  std::string name, unit;
  Eigen::Index column = 0;
  bool tested = false;  ///< residuals should not depend on it
};

/// Rows of one equation. They contain every column of the equation, so that any fit can be judged.
struct JudgedRows {
  std::size_t equation = 0;  ///< place among the job's
  Eigen::Index n_own = 0;    ///< columns of the equation
  std::vector<JudgedVariable> variables;
  Eigen::Index log = 0;  ///< column: number of the log, from 0
  std::unique_ptr<RowArchive> rows = std::make_unique<RowArchive>();
  Eigen::Index n_rows = 0;
  Eigen::Index last_number = 0;            ///< on the time grid
  std::vector<Eigen::Index> first_number;  ///< by log: start of its time grid

  const JudgedVariable& variable(std::string_view name) const;
};

/// Names of the variables that define conditions.
inline constexpr std::string_view kVelocity = "velocity", kLoad = "load", kDrive = "drive";

/// A drive that is off. The value is far from 1 and -1, so that decimation does not mix it with
/// them.
inline constexpr double kDriveOff = -10;

/// Rows of all equations of the job, from its own logs or others. Settings are the job's, converted
/// to the rate of each log. At most about `most_windows` windows of every log, evenly spread; 0:
/// all. Throws Error(input) for a log too slow for the job's cut-off.
std::vector<JudgedRows> judged_rows(const DynamicJob& job,
                                    const std::vector<EquationRows>& equations,
                                    std::span<const LogSurvey> logs, std::size_t most_windows);

}  // namespace cablefit
