// Stage 2 (Fichera & Grossard 2017, 4.1.2): inertias, frictions and offset from moving logs, given
// the elastic torque of stage 1.
//   link   J_link qdd + f_v qd + f_s sgn(qd)                       = tau_elas_l + tau_load
//   motor  J_motor thetadd + f_vm thetad + f_sm sgn(thetad) + offset = tau - tau_elas_m
#pragma once

#include <span>

#include "cablefit/dynamic/dynamic_options.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"

namespace cablefit {

/// Fits every preload of the moving logs. `elastic`: stage 1, may be empty for rigid drives. Throws
/// Error(input) for missing channels or stage-1 results, and Error(not_identifiable) when the logs
/// determine no parameter.
DynamicResult fit_dynamic(std::span<const LogSurvey> logs, const ElasticResult& elastic,
                          const DynamicOptions& options);

}  // namespace cablefit
