// Reads cablefit/batch/1 back: the fits of its cells.
#pragma once

#include <string>
#include <vector>

#include "cablefit/campaign/batch.hpp"

namespace cablefit {

class JsonNode;

/// The cells with their results of both stages, without what needs rig files (curves, effects).
/// Verdicts of refine and gates are not read. Throws Error(input) at file:line:column.
std::vector<BatchCell> parse_batch_cells(const JsonNode& root);

}  // namespace cablefit
