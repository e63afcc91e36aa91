// Where a torque wanders that no effect explains, a second look at rows freed of it: an effect that
// is small beside it may be told all the same. Internal to refine/.
#pragma once

#include "cablefit/refine/refine_bench.hpp"

namespace cablefit {

/// The state, refused all names, with the rows of the equation that wanders whitened, fitted so; of
/// the two states the unseen gap and the simulation that are better. Sets the floor of such rows.
/// Nothing: what is left does not wander.
std::optional<RefineState> whitened(RefineBench& bench, const RefineState& state);

/// Refuses candidates whose torque, squared, is less than `least` of what the rows leave as they
/// are: of whitened rows, what remains of a torque tells how sure it is, not how large.
void refuse_small(const Design& design, Search& found, double least);

}  // namespace cablefit
