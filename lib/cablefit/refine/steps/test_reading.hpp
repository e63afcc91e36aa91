// The test logs, read once, when everything is decided: they may take effects away, not choose
// others. Internal to refine/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/refine/steps/refine_bench.hpp"

namespace cablefit {

/// What a state leaves of the test logs, or of the last third of the training logs. An event of the
/// last training log is left out: the test logs may have been recorded without it.
struct TestReading {
  Design rows;
  Eigen::VectorXd x;
  RowGap gap;
  SimulatedGap simulated;
};

/// A chain with the values that are reported: those that simulate the training logs better, with
/// the bias of a fit by equation error or without it (fit_bias.hpp).
class ReportedValues {
 public:
  /// Decides by the last state.
  ReportedValues(const RefineBench& bench, const Chain& chain);
  RefineState of(const Chain& chain, std::size_t k) const;
  /// The bias of the last state, where it was found and the simulation does not fit better without
  /// it: it becomes part of the sd.
  const std::optional<ValueChange>& left() const { return left_; }

 private:
  std::vector<std::optional<ValueChange>> biases_;  ///< empty: values as they are fitted
  std::optional<ValueChange> left_;
};

struct Confirmed {
  ReportedValues values;
  std::vector<TestReading> readings;  ///< one per state of the chain
};

/// Takes effects from the end of the chain, and from the result, that the test logs contradict: the
/// equations or the closed loop fit worse, or all effects together close less than half of the gap.
/// Effects that were judged together go together.
Confirmed confirm_on_test(const RefineBench& bench, Chain& chain, RefineResult& result);

/// Takes the last effect away; its step says why.
void drop_last(const std::string& reason, Chain& chain, RefineResult& result);

/// Takes all effects away when together they close less than half of the gap on held-out blocks of
/// the training logs. They are a hint then.
void require_half_explained(Chain& chain, RefineResult& result);

/// Takes effects away that are no one law (agreement.hpp), and then what no longer closes half.
void require_one_law(const RefineBench& bench, Chain& chain, RefineResult& result);

}  // namespace cablefit
