#include "cablefit/model/arm.hpp"

#include "cablefit/base/catalog.hpp"
#include "cablefit/model/arm/kinds.hpp"

namespace cablefit {
namespace {

const std::vector<ArmKind>& arm_rows() {
  static const std::vector<ArmKind> kRows{arms::independent(), arms::planar_two_joint(),
                                          arms::serial(), arms::urdf()};
  return kRows;
}

}  // namespace

std::span<const ArmKind> arm_kinds() { return arm_rows(); }

const ArmKind& find_arm_kind(std::string_view name) { return find_row(arm_kinds(), "arm", name); }

std::vector<ParameterInfo> Arm::base_parameters() const {
  return kind == nullptr ? std::vector<ParameterInfo>{} : kind->base_parameters(parameters);
}

std::vector<double> Arm::described() const {
  return kind == nullptr || kind->described == nullptr ? std::vector<double>{}
                                                       : kind->described(parameters);
}

}  // namespace cablefit
