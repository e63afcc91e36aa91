// Warnings of stage 2 that do not come from an estimator. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Warns of deflections beyond those of stage 1. This warning comes first.
void note_extrapolations(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const ElasticResult& elastic, DynamicPreload& preload);

/// Warns of a stage 1 that left coefficients of taut cables open: its curve is one of several, and
/// offsets that it does not separate from the curve are refused.
void note_open_curves(const DynamicJob& job, DynamicPreload& preload);

/// Warns when the motor's dry friction differs from that of stage 1.
void note_blocked_friction(const DynamicJob& job, const ElasticResult& elastic,
                           DynamicPreload& preload);

/// Notes the load's inertia, and warns of logs without any load. Throws Error(input) for a load
/// that depends on a position that the log lacks.
void note_load(const DynamicJob& job, DynamicPreload& preload);

/// Warns when the link falls faster than a hanging mass: the load law is then wrong.
void note_free_fall(const Load& load, const std::vector<EquationRows>& equations,
                    DynamicPreload& preload);

/// Keeps one message per cause. Of every fit that explains little, only the worst equation is
/// reported, not the consequences. Neither is reported where the logs are read in units that cannot
/// be right (--trust-units), or where stage 1 had less than half of the deflections: those causes
/// come first.
void keep_causes(const DynamicJob& job, const std::vector<EquationRows>& equations,
                 const ElasticResult& elastic, DynamicPreload& preload);

}  // namespace cablefit
