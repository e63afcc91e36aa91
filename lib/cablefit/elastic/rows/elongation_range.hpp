// Elongations of the cables in the rows of a fit. They are measured cable by cable: theta - q gives
// them only where motor and link have pulleys of one radius.
#pragma once

#include <span>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Elongations that a cable reached, m or rad; empty (low > high) where there are no rows.
struct ElongationRange {
  double low = kUnbounded, high = -kUnbounded;

  void include(const ElongationRange& other);
  void include(const Eigen::Ref<const Eigen::VectorXd>& elongations);
  /// Largest distance from 0.
  double reach() const;
};

/// The high end of each range; <= 0: the cable is never taut.
std::vector<double> longest_of(std::span<const ElongationRange> ranges);

/// Deflections phi, Transmission::deflections.
struct DeflectionRange {
  double low = 0, high = 0;
};

/// How far the motor of one joint can turn until some cable leaves its range, with the link in its
/// reference position. Exact to 1e-12 of the travel. `ranges`: per cable, with the transmission's
/// l_o; the elongation of the reference pose counts as reached.
DeflectionRange reference_deflections(const Transmission& transmission,
                                      std::span<const ElongationRange> ranges);

}  // namespace cablefit
