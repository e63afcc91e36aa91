// One step of the search. Internal to refine/.
#pragma once

#include "cablefit/refine/search/scan.hpp"

namespace cablefit {

/// Whether two rows are of one alias class, which no data separate. The same law on the link and
/// on the motor is two.
bool same_class(const Effect& a, const Effect& b);

/// Rows that a design has, and their aliases.
std::vector<const Effect*> named_already(const Design& design);

struct Search {
  KindLevels levels{};  ///< weights that decided
  BlockGrams grams;
  BlockFit fit;  ///< of the design as it is
  std::vector<Candidate> candidates;
};

/// Every row but those already named and their aliases. Rows are weighted by the floor first, then
/// by what the best candidate leaves: a large unexplained part of one equation would hide the
/// other.
/// Throws Error(not_identifiable) when the design itself is singular.
Search search(const Design& design, const KindLevels& floor, const ScanSettings& settings);

/// The candidate with the largest gain that is physical and no event; nullptr: there is none.
const Candidate* best_lasting(const std::vector<Candidate>& candidates);

/// The `most` best of these, one of each alias class; not `but`, its aliases or events.
std::vector<const Candidate*> best_candidates(const std::vector<Candidate>& candidates,
                                              std::size_t most, const Effect& but);

}  // namespace cablefit
