// Rows with instruments beside the regressors. The instruments are the same columns for the
// noise-free loop's q and theta, with the same filter, decimation and masks.
#pragma once

#include <span>
#include <vector>

#include "cablefit/dynamic/loops/noise_free_loop.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Rows of one equation. After the columns of DynamicColumns come n_effects columns, the
/// instruments.
struct InstrumentedRows {
  RowStatistics rows;
  RowCounts counts;
};

/// The equation with its instruments after its own columns, for signals of 2 n joints (LogCopy).
/// The speed of the noise-free loop decides which rows are at rest. With the measured speed, the
/// choice of rows would depend on the disturbance that instruments must exclude (f_s of the link
/// -13 % at 3 N m of it). Motors of elastic drives are at rest when either speed says so.
/// Disturbances act on the link, not in the motor's equation, and no regressor describes a motor's
/// friction in true stiction (f_vm -12 % at low gain). A surrogate controller does not exclude
/// disturbances and reverses later than the drive, so there either speed decides for all axes (f_s
/// -5 %, f_v +4 % with an encoder of 12 bits).
Equation with_instruments(const EquationRows& equation, int n_joints, LoopKind loop);

/// All wanted rows of logs with simulated channels, per equation.
std::vector<InstrumentedRows> collect_instrumented(const DynamicJob& job,
                                                   std::span<const LogSurvey> simulated,
                                                   const std::vector<EquationRows>& equations,
                                                   LoopKind loop);

/// The problem of model number `which` for such rows, with instruments.
LinearProblem instrumented_problem(const DynamicJob& job, const EquationRows& equation,
                                   std::size_t which);

}  // namespace cablefit
