// IDIM-IV (Janot, Vandanjon & Gautier 2014). The instruments are the regressors of a noise-free
// closed loop, simulated with the current parameters and processed by the same filters and
// decimation as the measured ones. The simulation is repeated with the new estimates until they
// converge.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/loops/instrumented_rows.hpp"
#include "cablefit/dynamic/loops/noise_free_loop.hpp"
#include "cablefit/estimate/tests/exogeneity.hpp"

namespace cablefit {

/// Of each system (systems_of()): an equation alone, or those of the links of an arm, stacked.
struct IvFit {
  std::string failure;  ///< why there is no fit; empty: there is one
  int n_simulations = 0;
  double last_change = 0;                 ///< of any parameter in the last iteration, in its own sd
  std::vector<RowCounts> counts;          ///< per equation
  std::vector<RowStatistics> rows;        ///< per system
  std::vector<LinearSolution> solutions;  ///< on these rows
  std::vector<ExogeneityTest> tests;      ///< Durbin-Wu-Hausman, by these instruments

  bool converged() const;
};

/// At most this many simulations; 2 to 5 are usual.
inline constexpr int kMostSimulations = 6;

/// Fits model number `which` to the wanted parts of `logs`, which may be fewer than the job's.
/// `start`: per system the solution for the first simulation.
IvFit fit_by_instruments(const DynamicJob& job, std::span<const LogSurvey> logs,
                         const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& start, std::size_t which,
                         const LoopPlan& plan, int most_simulations = kMostSimulations);

}  // namespace cablefit
