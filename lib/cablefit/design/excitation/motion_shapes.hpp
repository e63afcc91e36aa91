// The table of shapes of a reference trajectory: `cablefit design --excite --shape`. A shape makes
// of some numbers a motion; a search finds the numbers. To add one: a function, one line in
// motion_shapes.cpp.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

namespace cablefit {

/// What a shape may know of the motion that it is for.
struct ShapeFrame {
  double duration = 0, period = 0;         ///< s
  double max_position = 0, max_speed = 0;  ///< rad (from the middle), rad/s
  double highest_frequency = 0;            ///< Hz; faster the drive does not follow
};

struct MotionShape {
  std::string_view name;
  std::string_view description;
  std::string_view source;
  Eigen::Index n_numbers;  ///< of one joint, each from 0 to 1
  /// Position at every period from 0 to the duration, starting at 0 and at rest. The caller scales
  /// it to `share` of the limits.
  Eigen::ArrayXd (*position)(const ShapeFrame& frame, const Eigen::ArrayXd& numbers);
  /// Share of the limits that is wanted, 0 to 1.
  double (*share)(const Eigen::ArrayXd& numbers);
  /// Numbers from which a search should start besides those drawn at random. nullptr: none.
  std::vector<Eigen::ArrayXd> (*starts)() = nullptr;
};

std::span<const MotionShape> motion_shapes();
/// Throws Error(input) with a suggestion.
const MotionShape& find_motion_shape(std::string_view name);

/// One sine, which a search is measured against; no row of the table.
const MotionShape& sine_shape();

}  // namespace cablefit
