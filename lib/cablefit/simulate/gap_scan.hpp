// Gap between a simulated and a measured signal, row by row in constant memory. Internal to
// simulate/.
#pragma once

#include <Eigen/Core>

#include "cablefit/simulate/simulate_result.hpp"

namespace cablefit {

class GapScan {
 public:
  /// The rows that follow belong to a window that starts at t (s).
  void start_window(double t);
  /// Signals over the same rows, the first at t0 (s), `period` s apart.
  void add(const Eigen::Ref<const Eigen::ArrayXd>& measured,
           const Eigen::Ref<const Eigen::ArrayXd>& simulated, double t0, double period);

  /// Writes all that is measured here into `gap`.
  void fill(SignalGap& gap) const;

 private:
  struct Sums {
    double n = 0, squares = 0;
    double rms() const;
  };
  void close_window(double* worst_rms, double* t_of_worst) const;

  Sums all_, window_;
  double t_window_ = 0, worst_rms_ = 0, t_of_worst_ = 0;
  double max_abs_ = 0, t_of_max_ = 0;
  double shift_ = 0, sum_ = 0, sum_squares_ = 0;  ///< of the measured signal less its first value
};

/// A 95 % band beside the gap, row by row.
class BandScan {
 public:
  /// Half widths of the band, and the sd of the sensor's noise.
  void add(const Eigen::Ref<const Eigen::ArrayXd>& gap,
           const Eigen::Ref<const Eigen::ArrayXd>& half_width, double noise);
  /// Writes the band into `gap`; nothing where there were no rows, or a width is no number.
  void fill(SignalGap& gap) const;

 private:
  double n_rows_ = 0, squares_ = 0, n_inside_ = 0;
};

/// How the cables were pulled, row by row.
class TensionScan {
 public:
  /// rows x cables; 0: slack.
  void add(const Eigen::ArrayXXd& tension);
  /// Per cable, in order.
  std::vector<CableTension> cables(const Transmission& transmission, const std::string& unit) const;
  /// Share of the rows with all cables taut.
  double closure_share() const;

 private:
  double n_rows_ = 0, n_closed_ = 0;
  Eigen::ArrayXd min_, max_, n_slack_;  ///< per cable
};

}  // namespace cablefit
