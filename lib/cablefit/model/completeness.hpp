// How complete the model in a file must be.
#pragma once

namespace cablefit {

/// `can_move`: the model can be simulated. `as_it_is`: it is well formed, and values that a fit
/// could not determine are NaN, inertias too.
enum class Completeness { can_move, as_it_is };

}  // namespace cablefit
