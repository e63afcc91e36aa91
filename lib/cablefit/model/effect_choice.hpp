// Which effects a list of parameters speaks of.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "cablefit/model/effects.hpp"

namespace cablefit {

/// The rows of a side of which a fit `has` a parameter (by its name in the table). A row that
/// stands in for another is one of them only when the fit has all of its parameters, and then the
/// other is not.
std::vector<const Effect*> effects_with(Side side,
                                        const std::function<bool(std::string_view)>& has);

}  // namespace cablefit
