// One step (Fichera & Grossard 2017, (26)-(28)): elastic and dynamic parameters of all preloads
// together, from blocked and moving logs.
//   blocked  tau_elas_m + f_vm_blocked thetad + f_sm_blocked sgn(thetad) + offset    = tau
//   motor    J_motor thetadd + f_vm thetad + f_sm sgn(thetad) + offset + tau_elas_m  = tau
//   link     J_link qdd + f_v qd + f_s sgn(qd) - tau_elas_l                          = tau_load
// Without moving logs f_sm_blocked is called f_sm. With n joints each joint has these equations,
// and its parameters have the joint's index. The equations of all joints that a cable passes share
// its coefficients and l_o. Links of a coupled arm have its base parameters instead of J_link.
#pragma once

#include <span>

#include "cablefit/identify/identify_options.hpp"
#include "cablefit/identify/identify_result.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Throws Error(input) for missing channels, rigs that do not match, and known l_o that are not in
/// equilibrium. Throws Error(not_identifiable) for too few rows, and for rows that these cables do
/// not explain.
IdentifyResult identify(std::span<const LogSurvey> logs, const IdentifyOptions& given);

}  // namespace cablefit
