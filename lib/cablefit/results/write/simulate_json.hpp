// cablefit/simulate/1: simulations beside their logs as a file, see
// data/schema/simulate.schema.json.
#pragma once

#include <string>

#include "cablefit/simulate/simulate_result.hpp"

namespace cablefit {

std::string simulate_json(const SimulateResult& result);

}  // namespace cablefit
