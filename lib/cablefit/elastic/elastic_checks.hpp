// What an expert would say about a stage-1 fit: pushing cables, loops, preload, which model will
// do.
#pragma once

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/passivity.hpp"

namespace cablefit {

/// Sets `passive` and warns where a cable pushes over the elongations that the rows reached: the
/// paper's (5) and (16).
void check_passive(ElasticFit& fit, const ElasticPreload& preload, const ElongationUnit& unit);

/// Fills `selected` and `selection`: the simplest model whose largest error on held-out blocks is
/// within `materiality` (share of the peak torque) of the best one's; significance is told beside
/// it.
void select_model(ElasticPreload& preload, double materiality);

/// Fills loop_half_width; warns when the torque depends on the path.
void note_loop(ElasticPreload& preload, bool plateaus);

/// Warns when the curve looks like two taut cables (preload) while l_o = 0 was assumed.
void note_closure(ElasticPreload& preload);

}  // namespace cablefit
