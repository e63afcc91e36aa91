// Adds an effect that a search identified on trial: the state with it, before any decision.
// Internal to refine/.
#pragma once

#include <optional>

#include "cablefit/refine/steps/refine_bench.hpp"
#include "cablefit/refine/verdict/verdict.hpp"

namespace cablefit {

struct Trial {
  Judgement judgement;
  Candidate winner;
  RefineState after;
};

/// Tries the effects that a search on one state found, one after the other. The state must outlive
/// it.
class Trials {
 public:
  /// Searches. `is_first`: no effect was identified before.
  Trials(RefineBench& bench, const RefineState& state, bool is_first);

  /// The best effect; nothing: there is none, or there is nothing to explain.
  std::optional<Trial> best();

  /// After a rejection: the best of the effects that the search does not separate from the last
  /// one, because a fit of all values may separate them. Nothing: there is none.
  std::optional<Trial> next_alike(const std::string& refusal);

  const Search& found() const { return found_; }
  const std::vector<Rival>& ranking() const { return ranking_; }
  /// For the largest gain of the search.
  const ChanceTail& chance() const { return chance_; }

 private:
  Judgement judged() const;
  std::optional<Trial> tried(Judgement judgement) const;

  RefineBench& bench_;
  const RefineState& state_;
  bool is_first_;
  Search found_;
  std::vector<Rival> ranking_;
  ChanceTail chance_;
  const Effect* last_ = nullptr;  ///< the last one tried
  std::vector<Rival> alike_;      ///< similar to the best
};

/// The best further effect that a search on this state finds.
std::optional<Trial> try_next(RefineBench& bench, const RefineState& state);

/// The state with one more effect, fitted with all that depends on its values; nothing when the
/// rows become singular.
std::optional<RefineState> with_candidate(const RefineBench& bench, const RefineState& state,
                                          const Search& found, const Candidate& winner);

}  // namespace cablefit
