// Reads cablefit/dynamic/1 back.
#pragma once

#include <string>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/model/rig.hpp"
#include "cablefit/results/read/elastic_reader.hpp"

namespace cablefit {

/// All of the file but for what it has of recursive estimators. With rig files each fit has its
/// curve of stage 1 and the effects beyond (31); a fit without "elastic" has no curve. Throws
/// Error(input) at file:line:column.
DynamicResult parse_dynamic_result(const JsonNode& root, RigFiles rig_files = RigFiles::read);

/// Of one of "preloads", without its fits; and of one of its "fits". `rig`: that of the preload;
/// nullptr: without curve and effects.
DynamicPreload read_dynamic_preload(const JsonNode& node);
DynamicFit read_dynamic_fit(const JsonNode& node, const Rig* rig);

/// The fit lists an inertia of a drive without elasticity.
bool is_rigid_fit(const DynamicFit& fit, const Rig& rig);

}  // namespace cablefit
