// On which rows `auto` decides about instruments, and whether these rows prove them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cablefit/dynamic/estimates/estimation.hpp"
#include "cablefit/dynamic/loops/instrumental_variables.hpp"

namespace cablefit {

/// The wanted rows, or of many evenly spaced stretches.
struct TestRows {
  std::vector<LogSurvey> stretches;  ///< empty: all rows
  std::string note;

  std::span<const LogSurvey> logs(const DynamicJob& job) const {
    return stretches.empty() ? job.logs : std::span<const LogSurvey>(stretches);
  }
};

TestRows rows_for_test(const DynamicJob& job);

/// Whether this log proves instruments that come from a surrogate loop, which keeps encoder noise
/// out but not what moved the robot.
struct InstrumentProof {
  bool agrees = false;  ///< with themselves at other cut-offs, within an sd
  bool better = false;  ///< held-out residuals share less with them than by least squares
  double moved = 0;     ///< sd, of the parameter that moves most between cut-offs
  std::string parameter;

  bool holds() const { return agrees && better; }
  std::string text() const;
};

/// Per system of the task's equations.
std::vector<InstrumentProof> prove_instruments(const EstimationTask& task, const TestRows& test,
                                               const IvFit& fit);

}  // namespace cablefit
