// What white noise of the sensors becomes in the rows of an equation.
#pragma once

#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// rms of rows * combination that noise on every channel makes, per equation, N m: the difference
/// between rows of the first windows with and without noise of the sensors' sd (position_noise of
/// every channel) added, through the same filter, derivatives and decimation. `combinations`: one
/// per equation, over its columns; what a sgn column does with noise at a reversal is left out. The
/// noise is made from a fixed seed.
std::vector<double> sensor_noise(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 const std::vector<Eigen::VectorXd>& combinations);

/// A combination of an equation's columns without the torques of a direction: what sgn does with
/// noise at a reversal is not known.
Eigen::VectorXd without_directions(Eigen::VectorXd combination, const DynamicColumns& columns);

}  // namespace cablefit
