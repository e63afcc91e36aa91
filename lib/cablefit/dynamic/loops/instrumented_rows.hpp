// Rows that carry instruments beside the regressors: the same columns once more, made of the
// noise-free loop's q and theta by the same filter, decimation and masks.
#pragma once

#include <span>
#include <vector>

#include "cablefit/dynamic/loops/noise_free_loop.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// One equation's rows with n_effects columns more than DynamicColumns has, the instruments.
struct InstrumentedRows {
  RowStatistics rows;
  RowCounts counts;
};

/// The equation with its instruments behind its own columns, for signals of 2 n joints (LogCopy).
/// Rest is judged by the speed of the noise-free loop: judged by the measured one, which rows stay
/// would depend on the disturbance that instruments are to keep out (f_s of the link -13 % at 3 N m
/// of it). Elastic motors rest by either: disturbances act on the link, not in their equation, and
/// what a motor's friction is where it really sticks no regressor says (f_vm -12 % at low gain). A
/// surrogate controller keeps no disturbance out and reverses later than the drive, so that there
/// all rest by either (f_s -5 %, f_v +4 % with an encoder of 12 bits).
Equation with_instruments(const EquationRows& equation, int n_joints, LoopKind loop);

/// All wanted rows of logs with simulated channels, per equation.
std::vector<InstrumentedRows> collect_instrumented(const DynamicJob& job,
                                                   std::span<const LogSurvey> simulated,
                                                   const std::vector<EquationRows>& equations,
                                                   LoopKind loop);

/// What model number `which` fits to such rows, with instruments.
LinearProblem instrumented_problem(const DynamicJob& job, const EquationRows& equation,
                                   std::size_t which);

}  // namespace cablefit
