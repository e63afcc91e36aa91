// What stage 2 cannot do without. Each throws an Error that names what is missing and what to do.
// Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/dynamic_job.hpp"

namespace cablefit {

void require_channels(const LogPlan& plan, bool rigid);

/// A torque that changes, of every joint.
void require_torque(const DynamicJob& job);

/// Of an equation, fewer say nothing.
inline constexpr int kRowsPerParameter = 4;

/// Enough rows in motion.
void require_rows(const EquationRows& equation, const std::string& preload);

/// The fit of stage 1 of that preload and model; its curve must hold the link, not push it.
const ElasticFit& require_stage1(const ElasticResult& elastic, const std::string& preload,
                                 const std::string& model);

}  // namespace cablefit
