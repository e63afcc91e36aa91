// A flexible joint without torque measurement (free oscillation): the logs determine only ratios to
// J_link.
#pragma once

#include <span>

#include "cablefit/dynamic/dynamic_fit.hpp"

namespace cablefit {

/// qdd = (K/J_link) (theta - q) - (f_v/J_link) qd - (f_s/J_link) sgn(qd) + constant. The constant
/// is an encoder zero times K/J_link and is not reported. Units s^-2, s^-1, rad/s^2.
DynamicPreload fit_ratios(std::span<const LogSurvey> logs, const std::string& name,
                          const PartFilter& wanted, const DynamicOptions& options);

}  // namespace cablefit
