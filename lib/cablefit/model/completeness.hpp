// How much of a model a file has to have.
#pragma once

namespace cablefit {

/// What a reader asks of a model: that it can be simulated, or no more than that it is well formed.
/// Then values that a fit could not determine are NaN, those of inertias too.
enum class Completeness { can_move, as_it_is };

}  // namespace cablefit
