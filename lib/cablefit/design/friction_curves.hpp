// Friction of a joint against the preload, from fits at several preloads.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/design/curves/preload_line.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// A fitted number of friction. sd: NaN when not known.
struct FittedFriction {
  std::string preload;
  double l_o = 0;      ///< of the first cable, m (rad in joint space); 0 when it is slack
  double tension = 0;  ///< N m, sum of all tensions at rest, each at the joint's motor pulley
  double value = 0, sd = 0;
};

struct FrictionValue {
  double value = 0, sd = 0, low = 0, high = 0;  ///< 95 % interval; NaN: sd not known
};

/// One number of friction against the preload: N m, or N m s/rad.
struct FrictionCurve {
  int joint = 0;
  std::string name;  ///< "f_s", "f_v", "f_sm", "f_vm", or kDryFriction
  std::string unit;
  std::vector<FittedFriction> points;  ///< of the preloads at which it is determined
  std::optional<PreloadLine> line;     ///< nothing: one preload, or all alike
  bool by_tension = false;             ///< the line is over the tension, else over l_o

  /// Nothing outside of the preloads that it is known for.
  std::optional<FrictionValue> at(double l_o, double tension) const;
};

/// Dry friction of link and motor together, of slow motion without load.
inline constexpr const char* kDryFriction = "f_dry";

/// A line over the sum of tensions at rest, c0 + c1 tension (capstan: friction of a cable on its
/// pulley grows with its tension); where that is not within the intervals of three or more
/// preloads (p < 5 %), or falls, a line over l_o if it is closer. Curve by curve, joint by joint,
/// in the order of the effects, kDryFriction last. Throws Error(input) for models with different
/// joints.
std::vector<FrictionCurve> friction_curves(std::span<const Model> fitted);

/// That of the joint and name; nullptr: none.
const FrictionCurve* find_curve(std::span<const FrictionCurve> curves, int joint,
                                const std::string& name);

/// Preloads that differ by less count as one.
bool same_preload(double l_o, double other);

}  // namespace cablefit
