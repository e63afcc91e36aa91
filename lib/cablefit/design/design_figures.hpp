// The curves of a sweep side by side. Internal to design/.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/design/design_sweep.hpp"

namespace cablefit {

/// Adds the curves of one design to the figures of the sweep, and its own figure of cables. Nothing
/// when options.figures is off.
void add_curves(const Model& model, const Transmission& preloaded, const DesignPoint& point,
                const DesignOptions& options, DesignResult& result);

/// What changes along the sweep; puts the figures in order.
void finish_figures(const DesignOptions& options, DesignResult& result);

/// "l_o = 5.12 mrad", "l_o = 5.12 mrad, radii x 0.8".
std::string point_name(const DesignPoint& point, const DesignResult& result);

}  // namespace cablefit
