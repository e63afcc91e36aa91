// What each cable gives, Fichera & Grossard 2017, Figs. 3d and 4.
#pragma once

#include "cablefit/figure/figure.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Torque on the motor of every cable and of all together against deflection (theta - theta_0 - q,
/// from `low` to `high`), the link in its reference position; marks where a cable goes slack.
/// One joint. Section and group are left to the caller.
Figure cable_figure(const Transmission& transmission, double low, double high, bool linear_motion);

}  // namespace cablefit
