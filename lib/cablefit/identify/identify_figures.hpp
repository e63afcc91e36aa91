// The one-step identification as plots: what the data say of each l_o.
#pragma once

#include <vector>

#include "cablefit/figure/figure.hpp"
#include "cablefit/identify/identify_result.hpp"

namespace cablefit {

/// A figure per profile of `result`.
std::vector<Figure> identify_figures(const IdentifyResult& result);

}  // namespace cablefit
