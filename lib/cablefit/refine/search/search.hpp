// One step of the search. Internal to refine/.
#pragma once

#include "cablefit/refine/search/scan.hpp"

namespace cablefit {

/// Whether two rows are of one alias class, which no data separate. The same law on the link and on
/// the motor counts as two.
bool same_class(const Effect& a, const Effect& b);

/// Rows that a design has, and their aliases.
std::vector<const Effect*> named_already(const Design& design);

struct Search {
  KindLevels levels{};  ///< weights of the decision
  BlockGrams grams;
  BlockFit fit;  ///< of the design without a candidate
  std::vector<Candidate> candidates;
};

/// Searches every row except those already identified and their aliases. Rows are weighted by the
/// floor first, then by the best candidate's residual. Otherwise a large residual of one equation
/// would dominate, and effects in the other would be smaller than it. Throws
/// Error(not_identifiable) when the design itself is singular.
Search search(const Design& design, const KindLevels& floor, const ScanSettings& settings);

/// The physical candidate with the largest gain that is no event; nullptr: there is none.
const Candidate* best_lasting(const std::vector<Candidate>& candidates);

/// The `most` best of these, one per alias class, without `but`, its aliases and events.
std::vector<const Candidate*> best_candidates(const std::vector<Candidate>& candidates,
                                              std::size_t most, const Effect& but);

}  // namespace cablefit
