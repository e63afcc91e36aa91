// Contacts of the link, by the means of its residual over windows (design/collision.hpp). Internal
// to predict/.
#pragma once

#include "cablefit/predict/predict.hpp"
#include "cablefit/predict/window_series.hpp"

namespace cablefit {

/// How far the mean of a window is from 0 without a contact.
struct WindowNoise {
  double sd = 0;  ///< N m
  std::string source;
};

/// Of logs without a contact where there are any, else of the model's fit, else of the watched log
/// itself, robustly.
WindowNoise window_noise(const std::vector<WindowSeries::Mean>& quiet, const Model& model,
                         const WindowSeries& watched);

/// Windows whose mean is beyond the threshold, neighbours as one contact. `quiet`: means of logs
/// without a contact, whose alarms are false.
ContactWatch watch(const WindowSeries& watched, const WindowNoise& noise,
                   const std::vector<WindowSeries::Mean>& quiet, const PredictOptions& options);

}  // namespace cablefit
