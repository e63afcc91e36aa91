// Describes a residual that no row of the catalogue explains: an unmodelled mode that the motion
// excites, a tone of fixed frequency, or a low-frequency disturbance. Internal to refine/.
#pragma once

#include <optional>

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// For the equation with the largest residual above its floor, with these values; nothing where all
/// are at their floor.
std::optional<Unexplained> describe_remainder(const Design& design, const Eigen::VectorXd& x,
                                              const KindLevels& floor, double block_seconds);

}  // namespace cablefit
