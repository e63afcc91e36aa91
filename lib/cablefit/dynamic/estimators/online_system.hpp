// Online estimation of one system: the rows of all its equations, in the order of time, update
// recursive least squares or a gradient. Internal to dynamic/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/dynamic/estimates/estimation.hpp"
#include "cablefit/estimate/fit/gradient.hpp"

namespace cablefit::estimation {

/// Rows of the time grid from number `first` to before `last`.
struct GridSpan {
  Eigen::Index first = 0, last = 0;
};

class OnlineSystem {
 public:
  /// `direct`: the fit to all rows; its bounds and given values hold here too. `samples`: the
  /// memory of the rule on the time grid, which sets the step of a gradient.
  OnlineSystem(const EstimationTask& task, const std::vector<std::size_t>& equations,
               const Estimation& direct, const OnlineRule& rule, double samples);

  /// Takes the rows of the span from a batch of all equations of the task. Returns their number.
  Eigen::Index take(const RowBatch& batch, const GridSpan& span);
  TracePoint point(const std::string& record) const;
  /// Power of the gradient's slowest direction over the average; 1: recursive.
  double slowest() const { return slowest_; }
  double step() const { return step_; }

 private:
  struct Part {
    Eigen::Index first = 0, n = 0;
  };
  Part part_of(const EquationBatch& batch, const GridSpan& span) const;
  void take_recursively(const RowBatch& batch, const std::vector<Part>& parts,
                        const GridSpan& span);
  void take_by_gradient(const RowBatch& batch, const std::vector<Part>& parts);

  std::vector<std::size_t> equations_;
  std::vector<JointBlock> blocks_;  ///< one per equation
  OnlineRule rule_;
  RecursiveInformation information_;
  std::optional<NormalisedGradient> gradient_;
  Eigen::Index seen_until_ = 0;  ///< on the time grid
  std::size_t n_rows_ = 0;
  double slowest_ = 1, step_ = 0, noise_sd_ = 0;
};

}  // namespace cablefit::estimation
