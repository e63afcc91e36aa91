// A serial arm made ready: its chain and the base parameters worked out from it, once.
#pragma once

#include <memory>
#include <vector>

#include "cablefit/model/arm.hpp"
#include "cablefit/model/arm/base_parameters.hpp"

namespace cablefit {

struct SerialArm {
  SerialChain chain;
  std::vector<BaseParameter> base;
  std::vector<Eigen::Index> kept;  ///< the columns of the regressor, one per base parameter
};

/// Throws as base_parameters_of.
std::shared_ptr<const SerialArm> serial_arm_of(SerialChain chain);

}  // namespace cablefit
