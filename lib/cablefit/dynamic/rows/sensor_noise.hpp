// White noise of the sensors in the rows of an equation.
#pragma once

#include <vector>

#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// rms of rows * combination that noise on every channel causes, per equation, N m. It is the
/// difference between rows of the first windows with and without added noise of the sensors' sd
/// (position_noise of every channel), after the same filter, derivatives and decimation.
/// `combinations`: one per equation, over its columns. The effect of noise on a sgn column at a
/// reversal is left out. The noise has a fixed seed.
std::vector<double> sensor_noise(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 const std::vector<Eigen::VectorXd>& combinations);

/// A combination of an equation's columns without torques that depend on the direction: the effect
/// of noise on sgn at a reversal is not included.
Eigen::VectorXd without_directions(Eigen::VectorXd combination, const DynamicColumns& columns);

}  // namespace cablefit
