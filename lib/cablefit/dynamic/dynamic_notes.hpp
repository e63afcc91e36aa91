// Warnings of stage 2 that no estimator sees. Internal to dynamic/.
#pragma once

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Deflections beyond those that stage 1 saw, before all else.
void note_extrapolations(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const ElasticResult& elastic, DynamicPreload& preload);

/// Dry friction of the motor that differs from that of stage 1.
void note_blocked_friction(const DynamicJob& job, const ElasticResult& elastic,
                           DynamicPreload& preload);

/// The load's inertia, and logs without any load. Throws Error(input) for a load that depends on a
/// position that the log lacks.
void note_load(const DynamicJob& job, DynamicPreload& preload);

/// A hanging mass that the link outruns is not the load that the law says.
void note_free_fall(const Load& load, const std::vector<EquationRows>& equations,
                    DynamicPreload& preload);

/// One cause, one message. Of every fit that explains little its worst equation is named, and not
/// what follows from that; nothing of both where the logs are read in units that cannot be right
/// (--trust-units), or where stage 1 saw less than half of the deflections: these come first.
void keep_causes(const DynamicJob& job, const std::vector<EquationRows>& equations,
                 const ElasticResult& elastic, DynamicPreload& preload);

}  // namespace cablefit
