// The elastic torque of a model as if stage 1 had found it: what stage 2 rests on when it fits the
// rest of that model anew.
#pragma once

#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {

/// One preload with one fit. Its covariance is that of the model's coefficients; where the file has
/// none, their squared sd.
ElasticResult curve_of(const Model& model);

}  // namespace cablefit
