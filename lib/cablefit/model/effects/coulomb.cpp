#include "cablefit/model/effects/rows.hpp"

namespace cablefit::rows {
namespace {

constexpr ParameterInfo kLink[] = {{"f_s", "f_s", "N m", "dry friction on the link side", 0}};
constexpr ParameterInfo kMotor[] = {{"f_sm", "f_sm", "N m", "dry friction on the motor side", 0}};
constexpr ParameterInfo kRigid[] = {{"f_s", "f_s", "N m", "dry friction of the whole drive", 0}};

constexpr PerSide<std::span<const ParameterInfo>> kParameters{kLink, kMotor, kRigid};
constexpr PerSide<std::string_view> kEquation{"f_s sgn(qd)", "f_sm sgn(thetad)", "f_s sgn(qd)"};

void regressor(const Motion& motion, Eigen::Ref<Eigen::MatrixXd> columns) {
  columns.col(0) = motion.direction.matrix();
}

double level(double /*position*/, double /*velocity*/, const double* parameters) {
  return parameters[0];
}

double level_slopes(double /*position*/, double /*velocity*/, const double* parameters,
                    double* slopes) {
  slopes[0] = slopes[1] = 0;
  slopes[2] = 1;
  return parameters[0];
}

}  // namespace

Effect coulomb(Side side) {
  return {.name = "coulomb",
          .side = side,
          .equation = kEquation.at(side),
          .source = "Fichera & Grossard 2017, (31)",
          .parameters = kParameters.at(side),
          .regressor = regressor,
          .smooth = nullptr,
          .dry = level,
          .inertia = nullptr,
          .is_affine = true,
          .follows = MotionPart::direction,
          .dry_slopes = level_slopes};
}

}  // namespace cablefit::rows
