// Reads cablefit/identify/1 back.
#pragma once

#include "cablefit/identify/identify_result.hpp"
#include "cablefit/results/read/elastic_reader.hpp"

namespace cablefit {

/// Estimates, ranges, decisions, profiles and what else the file has; with rig files also the
/// cables of each preload, and its model where the dynamics were identified. Throws Error(input) at
/// file:line:column.
IdentifyResult parse_identify_result(const JsonNode& root, RigFiles rig_files = RigFiles::read);

}  // namespace cablefit
