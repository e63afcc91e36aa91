// The elastic torque by every basis as a CSV table, for programs that interpolate one.
#pragma once

#include <string>

#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// A row per preload and deflection: torque on the motor and stiffness by every basis, SI.
std::string bases_csv(const ElasticResult& result);

}  // namespace cablefit
