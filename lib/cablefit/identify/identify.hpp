// One step (Fichera & Grossard 2017, (26)-(28)): elastic and dynamic parameters of all preloads
// together, from blocked and moving logs.
//   blocked  tau_elas_m + f_vm_blocked thetad + f_sm_blocked sgn(thetad) + offset    = tau
//   motor    J_motor thetadd + f_vm thetad + f_sm sgn(thetad) + offset + tau_elas_m  = tau
//   link     J_link qdd + f_v qd + f_s sgn(qd) - tau_elas_l                          = tau_load
// f_sm_blocked is called f_sm where there are no moving logs. With n joints every joint has these
// equations, and its parameters the joint's index; a cable's coefficients and l_o are shared by the
// equations of all joints that it passes. Links of an arm that move each other have its base
// parameters instead of J_link.
#pragma once

#include <span>

#include "cablefit/identify/identify_options.hpp"
#include "cablefit/identify/identify_result.hpp"
#include "cablefit/samples/survey/survey.hpp"

namespace cablefit {

/// Throws Error(input) for missing channels, rigs that do not match and known l_o that cannot
/// balance; Error(not_identifiable) when there are too few rows, or rows that these
/// cables do not explain.
IdentifyResult identify(std::span<const LogSurvey> logs, const IdentifyOptions& given);

}  // namespace cablefit
