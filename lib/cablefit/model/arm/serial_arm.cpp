#include "cablefit/model/arm/serial_arm.hpp"

#include <utility>

namespace cablefit {

std::shared_ptr<const SerialArm> serial_arm_of(SerialChain chain) {
  SerialArm arm{std::move(chain), {}, {}};
  arm.base = base_parameters_of(arm.chain);
  for (const BaseParameter& p : arm.base) arm.kept.push_back(p.kept());
  return std::make_shared<const SerialArm>(std::move(arm));
}

}  // namespace cablefit
