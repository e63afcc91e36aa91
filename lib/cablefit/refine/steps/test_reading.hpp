// The test logs, read once, when everything is decided. They may remove effects, not choose others.
// Internal to refine/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// Residual of a state on the test logs, or on the last third of the training logs. An event of the
/// last training log is left out: the test logs may have been recorded without it.
struct TestReading {
  Design rows;
  Eigen::VectorXd x;
  RowGap gap;
  SimulatedGap simulated;
};

/// A chain with the reported values. They are those that simulate the training logs better: with
/// the bias of a fit by equation error or without it (fit_bias.hpp).
class ReportedValues {
 public:
  /// The last state decides.
  ReportedValues(const RefineBench& bench, const Chain& chain);
  RefineState of(const Chain& chain, std::size_t k) const;
  /// The bias of the last state where the simulation is not better without it; it becomes part of
  /// the sd.
  const std::optional<ValueChange>& left() const { return left_; }

 private:
  std::vector<std::optional<ValueChange>> biases_;  ///< empty: fitted values
  std::optional<ValueChange> left_;
};

struct Confirmed {
  ReportedValues values;
  std::vector<TestReading> readings;  ///< one per state of the chain
};

/// Removes effects that the test logs contradict, from the end of the chain and from the result.
/// The test logs contradict when the equations or the closed loop fit worse, or when all effects
/// together explain less than half of the gap. Effects that were judged together are removed
/// together.
Confirmed confirm_on_test(const RefineBench& bench, Chain& chain, RefineResult& result);

/// Removes the last effect; its step records the reason.
void drop_last(const std::string& reason, Chain& chain, RefineResult& result);

/// Removes all effects when together they explain less than half of the gap on held-out blocks of
/// the training logs. They are then only a hint.
void require_half_explained(Chain& chain, RefineResult& result);

/// Removes effects that are not one law (agreement.hpp), and then all when the others explain less
/// than half.
void require_one_law(const RefineBench& bench, Chain& chain, RefineResult& result);

}  // namespace cablefit
