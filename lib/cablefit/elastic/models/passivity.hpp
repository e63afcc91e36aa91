// A cable only pulls: k(l) = f(l)/l >= 0 for every elongation in use (Fichera & Grossard 2017, (5),
// (16)). What that asks of the coefficients, and where a fit breaks it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// One row of the conditions, in words.
struct PullBound {
  std::size_t cable = 0;
  double at = 0;  ///< elongation
};

/// Up to this elongation the cable may only pull.
struct PullRange {
  std::size_t cable = 0;
  double longest = 0;
};

/// rows * (coefficients of all cables, one after the other) >= 0.
struct PullConstraints {
  Eigen::MatrixXd rows;
  std::vector<PullBound> bounds;  ///< one per row
  std::vector<PullRange> ranges;  ///< of the cables that the rows are about
};
/// Of the cables that are fitted and were ever taut. `fitted`: one per cable.
/// `longest`: elongation that each cable reached.
PullConstraints pull_constraints(const Transmission& transmission, const std::vector<bool>& fitted,
                                 std::span<const double> longest);

/// Where a cable pushes: k(l) < 0 for from < l < to (the hull, if there are several stretches).
struct Push {
  double from = 0, to = 0;
  double lowest = 0, lowest_at = 0;  ///< k, and where
};
/// None when the cable only pulls up to `longest`, up to rounding.
std::optional<Push> find_push(const Cable& cable, double longest);

/// "0 .. 13.8 mrad", "13.8 mrad" with the unit that suits elongations of the rig.
struct ElongationUnit {
  bool cable_space = false;
  Axes axes = Axes::rotary;

  std::string text(double elongation) const;
  std::string text(double from, double to) const;
  std::string stiffness() const;  ///< "N m/rad"
};

/// "cable 1 pushes over elongations of 0 .. 13.8 mrad, its k(l) = f(l)/l goes down to -3895 N m/rad
/// at 0 mrad".
std::string push_text(const Cable& cable, const Push& push, const ElongationUnit& unit);

}  // namespace cablefit
