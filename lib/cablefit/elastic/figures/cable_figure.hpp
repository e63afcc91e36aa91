// What each cable gives, and up to which torque all of them are taut; Fichera & Grossard 2017,
// Figs. 3d and 4.
#pragma once

#include <span>
#include <string>

#include "cablefit/base/axes.hpp"
#include "cablefit/figure/figure.hpp"
#include "cablefit/model/cables.hpp"

namespace cablefit {

/// Another model of the same joint, to see the fitted cables against.
struct ComparedModel {
  std::string name;
  Transmission transmission;
};

/// Torque on the motor of every cable and of all together against deflection (theta - theta_0 - q,
/// from `low` to `high`), the link in its reference position; marks where a cable goes slack, an
/// area for the deflections and torques between which all are taut, and by name which cables are
/// slack beside it. One joint. Section and group are left to the caller.
Figure cable_figure(const Transmission& transmission, double low, double high, Axes axes,
                    std::span<const ComparedModel> compared = {});

/// The stiffness d tau_elas_m / d theta of the cables against the same deflections, with the
/// others, the area and the marks of cable_figure().
Figure stiffness_figure(const Transmission& transmission, double low, double high, Axes axes,
                        std::span<const ComparedModel> compared = {});

}  // namespace cablefit
