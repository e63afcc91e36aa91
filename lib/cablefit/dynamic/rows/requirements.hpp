// What stage 2 cannot do without. Each throws an Error that names what is missing and what to do.
// Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

void require_channels(const LogPlan& plan, bool rigid);

/// A torque that changes, of every joint.
void require_torque(const DynamicJob& job);

/// Of several joints each moves beyond the noise of its encoders.
void require_motion(const DynamicJob& job);

/// Of an equation, fewer say nothing.
inline constexpr int kRowsPerParameter = 4;

/// Why an equation has only `n_rows` rows in motion: the motion is slow or short, or noise hides
/// it. `remedy`: what to do about the former.
std::string too_few_rows(const DynamicJob& job, const EquationRows& equation, std::size_t n_rows,
                         const std::string& remedy = "");

/// Enough rows in motion.
void require_rows(const EquationRows& equation, const DynamicJob& job);

/// The fit of stage 1 of that preload and model; its curve must hold the link, not push it.
const ElasticFit& require_stage1(const ElasticResult& elastic, const std::string& preload,
                                 const std::string& model);

}  // namespace cablefit
