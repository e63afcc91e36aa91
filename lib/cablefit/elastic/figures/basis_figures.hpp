// The bases of the cables' force as plots.
#pragma once

#include <vector>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// Stiffness against deflection by every basis, and the error on held-out blocks against the number
/// of terms. The preload's `bases` is there.
std::vector<Figure> basis_figures(const ElasticPreload& preload);

}  // namespace cablefit
