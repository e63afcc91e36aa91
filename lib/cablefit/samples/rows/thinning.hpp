// Quasi-static windows at a lower rate: motion far slower than the sample rate is carried by a
// fraction of the rows, and everything after costs that fraction.
#pragma once

#include "cablefit/samples/rows/signals.hpp"

namespace cablefit {

/// Rows per row that is kept, a divisor of `decimate`: the rate left is at least 16 cut-offs, so
/// that the low-pass that follows removes whatever a short filter let fold down, and at least 8
/// times the final rate. Columns are formed at it: powers of a deflection reach to higher
/// frequencies than the deflection does, and the torque's part up there must not be filtered away
/// alone (4 would move stiffnesses by 5e-5, 1 by 1e-3). 1: not quasi-static, or nothing to gain.
int thinning_step(const SignalSettings& settings, int decimate, double rate);

/// Rows on either side that a thinned row depends on.
Eigen::Index thinning_reach(int step);

/// Every `step`-th row of the segment, counted from its first, all columns through one short
/// zero-phase FIR; begin, end, first, rows_before and period count thinned rows.
Window thinned(const Window& window, int step);

}  // namespace cablefit
