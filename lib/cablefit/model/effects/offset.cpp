#include <cassert>

#include "cablefit/model/effects/rows.hpp"

namespace cablefit::rows {
namespace {

constexpr ParameterInfo kParameters[] = {
    {"offset", "offset", "N m",
     "constant torque of the drive: amplifier offset, gravity of the nut"}};

void regressor(const Motion& /*motion*/, Eigen::Ref<Eigen::MatrixXd> columns) {
  columns.col(0).setOnes();
}

double torque(double /*position*/, double /*velocity*/, const double* parameters) {
  return parameters[0];
}

double torque_slopes(double /*position*/, double /*velocity*/, const double* parameters,
                     double* slopes) {
  slopes[0] = slopes[1] = 0;
  slopes[2] = 1;
  return parameters[0];
}

}  // namespace

Effect offset(Side side) {
  assert(side != Side::link);
  return {.name = "offset",
          .side = side,
          .equation = "offset",
          .source = "Fichera & Grossard 2017, Table 2",
          .parameters = kParameters,
          .regressor = regressor,
          .smooth = torque,
          .dry = nullptr,
          .inertia = nullptr,
          .is_affine = true,
          .follows = MotionPart::constant,
          .smooth_slopes = torque_slopes};
}

}  // namespace cablefit::rows
