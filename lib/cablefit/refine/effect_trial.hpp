// What a search names, added on trial: the state with it, before anything is decided. Internal to
// refine/.
#pragma once

#include <optional>

#include "cablefit/refine/refine_bench.hpp"
#include "cablefit/refine/verdict.hpp"

namespace cablefit {

struct Trial {
  Judgement judgement;
  Candidate winner;
  RefineState after;
};

/// What a search on this state names; nothing: it names nothing, or there is nothing to explain.
/// `first_result`: gets the league of a first search.
std::optional<Trial> try_next(RefineBench& bench, const RefineState& state, bool is_first,
                              RefineResult* first_result);

/// The state with one more effect, fitted with what follows from its values; nothing when the rows
/// become singular.
std::optional<RefineState> with_candidate(const RefineBench& bench, const RefineState& state,
                                          const Search& found, const Candidate& winner);

}  // namespace cablefit
