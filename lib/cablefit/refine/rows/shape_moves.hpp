// The nonlinear parameters of the effects added to a design, as one list, and the design with other
// values of them. Internal to refine/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// A nonlinear parameter that was fitted on a range, see is_free.
struct FreeShape {
  std::size_t variant = 0;  ///< among Design::added
  std::size_t shape = 0;
};
/// In the order of FinalFit::covariance.
std::vector<FreeShape> free_shapes(const Design& design);

/// The unit of a step of it: the value on a geometric grid, else the whole range.
double unit_of(const Design& design, const FreeShape& at);

/// Whether the columns can be computed again from another value. Not for cables without
/// change_again, nor for a corrected recording.
bool can_move(const Variant& variant);

/// The design with `by` (one per free shape; empty: none) added to each shape that can move, within
/// its bounds. All columns are computed again with `values`. Unchanged where no shape moves.
Design with_shapes(Design design, const Eigen::VectorXd& by, const Eigen::VectorXd& values);

/// Difference of values from those of a design.
struct ValueChange {
  Eigen::VectorXd x;       ///< of all columns
  Eigen::VectorXd shapes;  ///< of every free shape; empty: none
};

/// The change from x and the design's shapes to the best fit of its rows, weighted by 1/level^2:
/// one Gauss-Newton step in the shapes. Shapes that are not separable from the columns do not
/// change, nor do those of `fixed`. Nothing where the columns are not separable.
std::optional<ValueChange> change_to_fit(const Design& design, const Eigen::VectorXd& x,
                                         const KindLevels& levels, double block_seconds,
                                         bool (*fixed)(const Effect& row));

}  // namespace cablefit
