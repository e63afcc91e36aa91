// Is an inertia that was found there at another cut-off too?
#pragma once

#include "cablefit/dynamic/estimates/estimation.hpp"

namespace cablefit {

/// The equations with their rows at `factor` times the cut-off.
struct OtherCutoff {
  double factor = 1;
  std::vector<EquationRows> equations;
};

/// With half and twice the cut-off, as far as the rate allows, for all models at once. None for
/// links that share parameters.
std::vector<OtherCutoff> rows_at_other_cutoffs(const DynamicJob& job,
                                               const std::vector<EquationRows>& equations);

/// Fits every equation again by least squares at the other cut-offs, and refuses the
/// inertias of `estimation` whose 95 % intervals there and here do not meet and that become more
/// than kMovedInertia times as large or small: filtered noise of speeds and torques has an
/// "inertia" of its own, that of a drive is the same in every band. One that moves less, but by
/// more than kMovementNoted, has the movement in its sd; so has one of an elastic drive, which
/// stiffness as well bends. Refused too: an inertia of a rigid drive whose acceleration, from a
/// speed channel, is noise.
void refuse_moving_inertias(const EstimationTask& task, const std::vector<OtherCutoff>& others,
                            Estimation& estimation);
inline constexpr double kMovedInertia = 2, kMovementNoted = 0.2;

}  // namespace cablefit
