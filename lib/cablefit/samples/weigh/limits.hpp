// Limits that several checks share, each with its reason.
#pragma once

#include <Eigen/Core>
#include <numbers>

namespace cablefit::weighing {

/// Correlation of two positions of one joint, or of theta and its reference.
inline constexpr double kFollows = 0.95;
/// Slope of one on the other: stretch of the cables and resonance stay within.
inline constexpr double kLowRatio = 0.5, kHighRatio = 2;
/// Relative deviation of a slope from a unit's factor.
inline constexpr double kSameUnit = 0.03;
/// In a radian.
inline constexpr double kDegrees = 180 / std::numbers::pi;
/// Of coarse samples: fewer show no correlation.
inline constexpr Eigen::Index kFewBlocks = 20;

}  // namespace cablefit::weighing
