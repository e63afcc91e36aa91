// Held-out blocks: a log is cut into 20 stretches of time, dealt to 5 folds in turn. Each fold is
// predicted by a fit to the other four. Blocks, not rows: neighbours in time know each other.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/elastic/models/candidates.hpp"
#include "cablefit/estimate/solve/row_statistics.hpp"

namespace cablefit {

inline constexpr Eigen::Index kHeldOutFolds = 5;
inline constexpr Eigen::Index kHeldOutBlocks = 20;

class HeldOut {
 public:
  explicit HeldOut(const RowStatistics& rows);

  Eigen::Index block_of(Eigen::Index cell_id) const;
  Eigen::Index block_of_row(Eigen::Index row_number) const {
    return block_of(row_number / cell_rows_);
  }
  Eigen::Index fold_of_row(Eigen::Index row_number) const {
    return block_of(row_number / cell_rows_) % kHeldOutFolds;
  }
  /// For each fold the residual combination (rows * it = residual) of the fit to the other folds.
  /// They are as passive as the candidate's own fit.
  std::vector<Eigen::VectorXd> fits(const ElasticCandidate& candidate,
                                    const Eigen::VectorXd& response) const;
  /// Mean squared held-out residual of every block that has rows, given fits().
  Eigen::VectorXd block_errors(const std::vector<Eigen::VectorXd>& fits) const;

 private:
  Eigen::Index cell_rows_ = 1, first_id_ = 0, last_id_ = 0;
  std::vector<Eigen::MatrixXd> block_grams_;
  std::vector<Eigen::Index> block_rows_;
};

/// The errors `high` of a larger model are significantly and materially below those of a smaller
/// one, by a paired test over blocks.
bool beats(const Eigen::VectorXd& high, const Eigen::VectorXd& low);

}  // namespace cablefit
