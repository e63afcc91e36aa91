#include "cablefit/model/effects/rows.hpp"

namespace cablefit::rows {
namespace {

constexpr ParameterInfo kLink[] = {
    {"f_v", "f_v", "N m s/rad", "viscous friction on the link side", 0}};
constexpr ParameterInfo kMotor[] = {
    {"f_vm", "f_vm", "N m s/rad", "viscous friction on the motor side", 0}};
constexpr ParameterInfo kRigid[] = {
    {"f_v", "f_v", "N m s/rad", "viscous friction of the whole drive", 0}};

constexpr PerSide<std::span<const ParameterInfo>> kParameters{kLink, kMotor, kRigid};
constexpr PerSide<std::string_view> kEquation{"f_v qd", "f_vm thetad", "f_v qd"};

void regressor(const Motion& motion, Eigen::Ref<Eigen::MatrixXd> columns) {
  columns.col(0) = motion.velocity.matrix();
}

double torque(double /*position*/, double velocity, const double* parameters) {
  return parameters[0] * velocity;
}

double torque_slopes(double /*position*/, double velocity, const double* parameters,
                     double* slopes) {
  slopes[0] = 0;
  slopes[1] = parameters[0];
  slopes[2] = velocity;
  return parameters[0] * velocity;
}

}  // namespace

Effect viscous(Side side) {
  return {.name = "viscous",
          .side = side,
          .equation = kEquation.at(side),
          .source = "Fichera & Grossard 2017, (31)",
          .parameters = kParameters.at(side),
          .regressor = regressor,
          .smooth = torque,
          .dry = nullptr,
          .inertia = nullptr,
          .is_affine = true,
          .follows = MotionPart::velocity,
          .smooth_slopes = torque_slopes};
}

}  // namespace cablefit::rows
