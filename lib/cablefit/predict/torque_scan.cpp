#include "cablefit/predict/torque_scan.hpp"

#include <cmath>
#include <limits>

namespace cablefit {

void TorqueScan::add(double t, double error, double sensor) {
  ++n_rows_;
  squares_ += error * error;
  sensor_squares_ += sensor * sensor;
  if (std::abs(error) <= largest_) return;
  largest_ = std::abs(error);
  t_of_largest_ = t;
}

void TorqueScan::fill(SensedTorque& torque) const {
  torque.n_rows = n_rows_;
  if (n_rows_ == 0) return;
  torque.rms = std::sqrt(squares_ / static_cast<double>(n_rows_));
  torque.max_abs = largest_;
  torque.t_of_max = t_of_largest_;
  torque.relative = torque.is_measured ? std::sqrt(squares_ / sensor_squares_)
                                       : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace cablefit
