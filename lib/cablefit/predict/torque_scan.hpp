// A torque by the model beside the sensor's, row by row in constant memory. Internal to predict/.
#pragma once

#include <string>

#include "cablefit/predict/predict_result.hpp"

namespace cablefit {

class TorqueScan {
 public:
  /// `error`: model minus sensor; `sensor`: measured; both N m. Without a sensor the error is the
  /// torque itself.
  void add(double t, double error, double sensor);
  std::size_t n_rows() const { return n_rows_; }
  /// Fills the numbers of `torque`, whose is_measured is set.
  void fill(SensedTorque& torque) const;

 private:
  std::size_t n_rows_ = 0;
  double squares_ = 0, sensor_squares_ = 0;
  double largest_ = 0, t_of_largest_ = 0;
};

}  // namespace cablefit
