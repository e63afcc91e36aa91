// From logs to results, stage by stage: each takes the logs it needs from all that are given.
#pragma once

#include <span>

#include "cablefit/dynamic/dynamic_options.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/refine/refine.hpp"

namespace cablefit {

/// Those with a part of this phase.
std::vector<LogSurvey> logs_of(std::span<const LogSurvey> logs, Phase phase);

/// Stage 1 from the logs with the link blocked: K, or K1_0, K1_1, ... of each preload (N m/rad, N
/// m/rad^2, ...; with cables in the rig file N/m, N/m^2, ...). An initial elongation is searched
/// where the rig file or the curve asks for it. Throws as fit_elastic().
ElasticResult stiffness(std::span<const LogSurvey> logs, const ElasticOptions& options = {});

/// Stage 2 from the logs in which the link moves: J_link, J_motor (kg m^2), f_v, f_vm (N m s/rad),
/// f_s, f_sm, offset (N m). `stage1`: of the same rigs; none for a rigid drive (model "rigid").
/// Throws as fit_dynamic().
DynamicResult dynamics(std::span<const LogSurvey> logs, const ElasticResult& stage1,
                       const DynamicOptions& options = {});

/// Where models disagree with the logs, and which effect is missing. `models`: one per preload, and
/// what they lack gets start values; none: fitted to the logs, moving and blocked ones. Without
/// test logs the last third of every moving one is held out. Throws as own_base() and refine(), and
/// Error(usage) for models that do not match.
RefineResult missing_effects(const RefineLogs& logs, std::vector<Model> models,
                             const RefineOptions& options);
RefineResult missing_effects(const RefineLogs& logs, const RefineOptions& options = {});

}  // namespace cablefit
