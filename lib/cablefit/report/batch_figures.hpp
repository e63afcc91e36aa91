// What a campaign shows at a glance: every parameter against the preload, with its interval.
#pragma once

#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// One figure per parameter, one trace per model. Parameters of a single preload are left out, they
/// have nothing to be compared with.
std::vector<Figure> parameter_figures(const ElasticResult& elastic, const DynamicResult& dynamic);

}  // namespace cablefit
