// Radii of pulleys with which the base fits of all joints leave least. Internal to refine/.
#pragma once

#include <vector>

#include "cablefit/refine/rig_errors/radius_fit.hpp"

namespace cablefit {

/// Radii where the squared residual is least.
struct FittedRadii {
  RadiusChanges changes;
  CommonStep near;  ///< the step that is left, nearly 0, with its covariance (m^2)
  RadiusFit::Errors errors;
  double given = 0;  ///< squared residual with the given radii

  double fall() const { return given - errors.sum(); }
  /// Of the radius with this number, m.
  double sd(std::size_t k) const;
  /// Of the t distribution of this radius.
  double dof(std::size_t k) const;
};

/// One radius each: of the pulleys that promise most, the best first.
std::vector<FittedRadii> single_radii(const RadiusFit& fit, const std::vector<Pulley>& pulleys);

/// Several radii from these on (Gauss-Newton, steps that are halved until the residual falls).
/// Nothing where the rows do not determine them together, or where the steps do not end.
std::optional<FittedRadii> fitted_radii(const RadiusFit& fit, RadiusChanges changes);

/// These radii, fitted again together with one more of the pulleys; the best first.
std::vector<FittedRadii> with_one_more(const RadiusFit& fit, const FittedRadii& radii,
                                       const std::vector<Pulley>& pulleys);

/// Pairs of radii that promise most at the given radii, to first order; the best first.
std::vector<FittedRadii> radius_pairs(const RadiusFit& fit, const std::vector<Pulley>& pulleys);

/// Whether both leave the same on the same joints, to within the scatter over blocks of time, or to
/// 2 % of what the radius in which they differ removes. `fall_before`: without that radius.
bool is_as_good(const FittedRadii& one, const FittedRadii& best, double fall_before);

/// These radii as the rig file has them.
RadiusChanges unchanged(RadiusChanges radii);

/// The next step of these radii.
std::optional<CommonStep> step_of(const RadiusFit& fit, const RadiusChanges& changes);

}  // namespace cablefit
