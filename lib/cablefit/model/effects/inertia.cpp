#include "cablefit/model/effects/rows.hpp"

namespace cablefit::rows {
namespace {

constexpr ParameterInfo kLink[] = {
    {"J_link", "J_M", "kg m^2", "inertia of the link, with the mass that hangs on it", 0}};
constexpr ParameterInfo kMotor[] = {
    {"J_motor", "J_m", "kg m^2", "inertia of the motor and its reduction, after the reduction", 0}};
constexpr ParameterInfo kRigid[] = {{"J", "J", "kg m^2", "inertia of the whole drive", 0}};

constexpr PerSide<std::span<const ParameterInfo>> kParameters{kLink, kMotor, kRigid};
constexpr PerSide<std::string_view> kEquation{"J_link qdd", "J_motor thetadd", "J qdd"};
constexpr PerSide<std::string_view> kSource{"Fichera & Grossard 2017, (14a)",
                                            "Fichera & Grossard 2017, (14b)",
                                            "Fichera & Grossard 2017, (14) with rigid cables"};

void regressor(const Motion& motion, Eigen::Ref<Eigen::MatrixXd> columns) {
  columns.col(0) = motion.acceleration.matrix();
}

double added_inertia(const double* parameters) { return parameters[0]; }

void inertia_slopes(const double* /*parameters*/, double* slopes) { slopes[0] = 1; }

}  // namespace

Effect inertia(Side side) {
  return {.name = "inertia",
          .side = side,
          .equation = kEquation.at(side),
          .source = kSource.at(side),
          .parameters = kParameters.at(side),
          .regressor = regressor,
          .smooth = nullptr,
          .dry = nullptr,
          .inertia = added_inertia,
          .is_affine = true,
          .follows = MotionPart::acceleration,
          .inertia_slopes = inertia_slopes};
}

}  // namespace cablefit::rows
