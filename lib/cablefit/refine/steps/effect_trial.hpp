// What a search names, added on trial: the state with it, before anything is decided. Internal to
// refine/.
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

/// Names what a search on one state found, one after the other. The state has to outlive it.
class Trials {
 public:
  /// Searches. `is_first`: no effect was named before.
  Trials(RefineBench& bench, const RefineState& state, bool is_first);

  /// The best name; nothing: there is none, or there is nothing to explain.
  std::optional<Trial> best();

  /// Where the last one was refused: the best of those that a search does not separate from it, as
  /// a fit of all values may; nothing: there is none.
  std::optional<Trial> next_alike(const std::string& refusal);

  const Search& found() const { return found_; }
  const std::vector<Rival>& ranking() const { return ranking_; }
  /// Of the largest gain that the search found.
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
  const Effect* last_ = nullptr;  ///< tried
  std::vector<Rival> alike_;      ///< of the best
};

/// The best name that a search on this state finds for a further effect.
std::optional<Trial> try_next(RefineBench& bench, const RefineState& state);

/// The state with one more effect, fitted with what follows from its values; nothing when the rows
/// become singular.
std::optional<RefineState> with_candidate(const RefineBench& bench, const RefineState& state,
                                          const Search& found, const Candidate& winner);

}  // namespace cablefit
