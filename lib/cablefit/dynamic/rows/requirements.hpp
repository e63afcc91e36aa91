// Requirements of stage 2. Each function throws an Error that states what is missing and what to
// do. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

void require_channels(const LogPlan& plan, bool rigid);

/// Requires a torque that changes, for every joint.
void require_torque(const DynamicJob& job);

/// With several joints, requires that each moves beyond the noise of its encoders.
void require_motion(const DynamicJob& job);

/// Minimum for an equation.
inline constexpr int kRowsPerParameter = 4;

/// Why an equation has only `n_rows` rows in motion: the motion is slow or short, or noise hides
/// it. `remedy`: what to do about a slow or short motion.
std::string too_few_rows(const DynamicJob& job, const EquationRows& equation, std::size_t n_rows,
                         const std::string& remedy = "");

/// Requires enough rows in motion.
void require_rows(const EquationRows& equation, const DynamicJob& job);

/// The fit of stage 1 for that preload and model. A linear fit must have a positive stiffness.
const ElasticFit& require_stage1(const ElasticResult& elastic, const std::string& preload,
                                 const std::string& model);

}  // namespace cablefit
