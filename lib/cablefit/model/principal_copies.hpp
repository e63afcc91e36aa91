// Copies of a model that span what its parameters may be together.
#pragma once

#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

/// A model moved along one principal axis of the joint covariance of its parameters.
struct MovedModel {
  Model model;
  double by = 1;  ///< standard deviations; negative: down the axis
};

/// One copy per principal axis of the correlations, an sd aside, or as much less as keeps every
/// parameter within its physical bounds. To first order the variance of any result y is
/// sum ((y_k - y) / by_k)^2 (delta method; Oehlert 1992). Empty: the covariance is not known.
std::vector<MovedModel> principal_copies(const Model& model);

}  // namespace cablefit
