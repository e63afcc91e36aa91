// What follows from a fitted transmission: stiffness at rest, and where cables go slack.
#pragma once

#include <functional>
#include <vector>

#include "cablefit/base/axes.hpp"
#include "cablefit/estimate/fit/derived_quantity.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Deflections theta - q of the blocked rows.
struct UsedDeflections {
  double low = 0, high = 0;
};

/// Slope of the elastic torque of a one-joint rig in its reference pose, N m/rad: df/dl summed over
/// the taut cables times the radii of both sides; the mean of both sides' slopes, from 20 urad on.
double rest_stiffness(const Transmission& transmission);

/// `transmission` with the coefficients and initial elongations (coefficient_name(),
/// elongation_name(), or K) that are among the estimates.
using TransmissionOf = std::function<Transmission(const Eigen::VectorXd&)>;
TransmissionOf transmission_of(const Transmission& transmission, bool cable_space,
                               const JointEstimates& from);

/// K_rest of fitted cables; of a preloaded pair also the deflection and the torque at which each
/// cable goes slack ("phi_slack[1]", "tau_slack[1]"). Of several preloaded joints K_rest[i,j].
std::vector<DerivedQuantity> elastic_quantities(const Transmission& transmission, bool cable_space,
                                                const JointAxes& axes, const UsedDeflections& used,
                                                const JointEstimates& from);

}  // namespace cablefit
