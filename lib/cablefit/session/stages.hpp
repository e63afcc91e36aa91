// From logs to results, stage by stage. Each stage takes the logs that it needs from all given
// logs.
#pragma once

#include <span>

#include "cablefit/dynamic/dynamic_options.hpp"
#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/elastic/elastic_fit.hpp"
#include "cablefit/identify/identify.hpp"
#include "cablefit/refine/refine.hpp"

namespace cablefit {

/// The logs with a part of this phase.
std::vector<LogSurvey> logs_of(std::span<const LogSurvey> logs, Phase phase);

/// Stage 1 from the logs with the link blocked: K, or K1_0, K1_1, ... of each preload (N m/rad, N
/// m/rad^2, ...; with cables in the rig file N/m, N/m^2, ...). It searches an initial elongation
/// where the rig file or the curve requires it. Throws as fit_elastic().
ElasticResult stiffness(std::span<const LogSurvey> logs, const ElasticOptions& options = {});

/// Stage 2 from the logs in which the link moves: J_link, J_motor (kg m^2), f_v, f_vm (N m s/rad),
/// f_s, f_sm, offset (N m). `stage1`: of the same rigs; empty for a rigid drive (model "rigid").
/// Throws as fit_dynamic().
DynamicResult dynamics(std::span<const LogSurvey> logs, const ElasticResult& stage1,
                       const DynamicOptions& options = {});

/// Where models disagree with the logs, and which effect is missing. `models`: one per preload;
/// values that they lack get start values. None: models are fitted to the moving and blocked logs.
/// Without test logs the last third of every moving log is held out. Throws as own_base() and
/// refine(), and Error(usage) for models that do not match.
RefineResult missing_effects(const RefineLogs& logs, std::vector<Model> models,
                             const RefineOptions& options);
RefineResult missing_effects(const RefineLogs& logs, const RefineOptions& options = {});

}  // namespace cablefit
