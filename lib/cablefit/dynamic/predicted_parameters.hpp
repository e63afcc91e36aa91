// What the rows of one equation determine about each parameter. Internal to prediction.cpp.
#pragma once

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/prediction.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// The rows of one system of equations, and the rough model's fit to them.
struct PredictedSystem {
  const DynamicColumns& columns;
  const RowStatistics& rows;
  LinearSolution solution;
  DynamicFit fit;
  double noise = 0;  ///< rms, with the weights of the rows
};

/// Adds parameters, scaled condition number and sentences.
void add_parameters(const PredictedSystem& system, PredictedEquation& out);

}  // namespace cablefit
