// A model put together of estimates by name: what every fit and every result file becomes.
#pragma once

#include "cablefit/model/model.hpp"

namespace cablefit {

/// Every base effect of every joint of which `find` has the parameter, and the base parameters of a
/// coupled arm: all of them or none. Without name, cables and effects beyond (31).
Model assembled_model(const Rig& rig, bool rigid, const FindEstimate& find);

/// K of every joint, or the coefficients of every cable and then the initial elongations: those
/// that `find` has.
std::vector<Estimate> elastic_estimates(const Transmission& transmission, const Rig& rig,
                                        const FindEstimate& find);

}  // namespace cablefit
