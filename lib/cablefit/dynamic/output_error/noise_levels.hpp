// Noise of the forces of a log, by maximum likelihood of the filter's predictions.
#pragma once

#include <span>

#include "cablefit/dynamic/output_error/prediction_filter.hpp"

namespace cablefit {

/// The force noise of every axis that makes the predictions of `windows` most likely under this
/// model, from `start` on (Schweppe 1965; Nelder & Mead 1965 on its logarithms). Position noise is
/// known and fixed. Model error counts as force noise. `first_step`: of the logarithms, about the
/// error of `start`.
NoiseLevels likeliest_noise(const Model& model, std::span<const OutputErrorWindow> windows,
                            const NoiseLevels& start, const FilterSettings& settings,
                            double first_step, int max_evaluations);

}  // namespace cablefit
