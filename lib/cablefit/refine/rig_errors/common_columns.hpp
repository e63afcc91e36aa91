// Values that the equations of several joints have in common, beside the linear parameters that
// each joint has of its own. Internal to refine/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// The change of such values that lets the squared residual of all joints fall most, to first order
/// (Gauss-Newton).
struct CommonStep {
  Eigen::VectorXd change;
  Eigen::MatrixXd covariance;  ///< sandwich over blocks of time
  Eigen::VectorXd n_blocks;    ///< that show each value
  double fall = 0;             ///< of the squared residual, weighted
};

/// Columns of such values, without the part that the columns of each joint can stand for.
class CommonColumns {
 public:
  explicit CommonColumns(Eigen::Index n_values);

  /// The equations of one joint. `grams`: those of its own columns, followed by the common ones:
  /// torque per unit of each value. `x`: its own parameters.
  void add_joint(const BlockGrams& grams, const KindLevels& levels, const Eigen::VectorXd& x);

  /// Of all combinations of the values (unit vectors), the one whose column is largest beside the
  /// joints' own ones. The values have one unit.
  Eigen::VectorXd most_shown() const;

  /// Of these values alone, which have one unit. Nothing where a combination of their columns has
  /// less than `least_own` of their squares beside the joints' own columns, or where a value shows
  /// in no more blocks than there are values.
  std::optional<CommonStep> step(const std::vector<Eigen::Index>& of, double least_own) const;

 private:
  struct Block {
    Eigen::VectorXd right;    ///< right-hand side
    Eigen::VectorXd squares;  ///< of the columns
  };
  Eigen::MatrixXd matrix_;   ///< of the normal equations
  Eigen::VectorXd squares_;  ///< of the columns, before the joint's own ones are removed
  std::vector<Block> blocks_;
};

}  // namespace cablefit
