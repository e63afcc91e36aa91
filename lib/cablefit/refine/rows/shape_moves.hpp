// The nonlinear parameters of what was added to a design, counted in one row, and the design with
// others. Internal to refine/.
#pragma once

#include <optional>
#include <vector>

#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// One that was looked for on a range, see is_free.
struct FreeShape {
  std::size_t variant = 0;  ///< among Design::added
  std::size_t shape = 0;
};
/// In the order of FinalFit::covariance.
std::vector<FreeShape> free_shapes(const Design& design);

/// What a step of it is a share of: the value on a geometric grid, the whole range on another.
double unit_of(const Design& design, const FreeShape& at);

/// Whether the columns can be made anew from another value: not of cables that nothing follows from
/// again, nor of a recording that was corrected.
bool can_move(const Variant& variant);

/// The design with `by` (one per free shape; empty: none) added to each that can move, within its
/// bounds, and all columns made anew with `values` of them; as it is where nothing moves.
Design with_shapes(Design design, const Eigen::VectorXd& by, const Eigen::VectorXd& values);

/// How values differ from those of a design.
struct ValueChange {
  Eigen::VectorXd x;       ///< of all columns
  Eigen::VectorXd shapes;  ///< of every free shape; empty: none
};

/// From x and the design's shapes to what fits its rows best, weighted by 1/level^2: one step of
/// Gauss & Newton in the shapes. Those that are not separable from the columns stay, as do those of
/// `fixed`. Nothing where the columns are not separable.
std::optional<ValueChange> change_to_fit(const Design& design, const Eigen::VectorXd& x,
                                         const KindLevels& levels, double block_seconds,
                                         bool (*fixed)(const Effect& row));

}  // namespace cablefit
