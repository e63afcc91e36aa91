// Does another cut-off confirm an identified inertia?
#pragma once

#include <memory>
#include <vector>

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// The equations with their rows at `factor` times the cut-off.
struct OtherCutoff {
  double factor = 1;
  std::vector<EquationRows> equations;
  std::shared_ptr<const std::vector<LogSurvey>> stretches;  ///< whose rigs the equations refer to
};

/// Rows with half and twice the cut-off, as far as the rate allows, for all models at once. None
/// for links that share parameters.
std::vector<OtherCutoff> rows_at_other_cutoffs(const DynamicJob& job,
                                               const std::vector<EquationRows>& equations);

/// Fits every equation again by least squares at the other cut-offs. It refuses an inertia of a
/// rigid drive when the 95 % intervals at the two cut-offs do not overlap and the inertia changes
/// by more than the factor kMovedInertia. The reason: filtered noise of speeds and torques has an
/// apparent inertia, but that of a drive is the same in every band. A smaller change, but above
/// kMovementNoted, becomes part of the sd. So does any larger change on an elastic drive, where an
/// error of the stiffness causes one too. An inertia of a rigid drive is also refused when its
/// acceleration comes from a speed channel and is too noisy.
void refuse_moving_inertias(const EstimationTask& task, const std::vector<OtherCutoff>& others,
                            Estimation& estimation);
inline constexpr double kMovedInertia = 2, kMovementNoted = 0.2;

}  // namespace cablefit
