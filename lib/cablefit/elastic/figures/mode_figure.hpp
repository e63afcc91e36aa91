// Force closure and disclosure over the positions of a joint, Fichera & Grossard 2017, (12)-(13).
#pragma once

#include "cablefit/base/axes.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Map over q and theta (as logged) of `joint` (from 0) of the cables that it moves: the line on
/// which each goes slack, where all are taut, and by name which are not. The other joints are in
/// their reference pose. `q` and `theta`: seen in the logs; of a link that was blocked in one place
/// as much of q is shown as moves the cables as far as theta did. Lines are linear between 121
/// places each way: exact for round pulleys. Section and group are left to the caller.
Figure mode_figure(const Transmission& transmission, int joint, ChannelRange q, ChannelRange theta,
                   Axes axes);

}  // namespace cablefit
