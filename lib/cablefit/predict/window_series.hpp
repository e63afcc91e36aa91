// Means of a residual over windows of time, side by side. Internal to predict/.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

class WindowSeries {
 public:
  /// `seconds`: of a window; at least one row. `row_seconds`: between rows.
  WindowSeries(double seconds, double row_seconds);

  /// Rows in order of time (s). A window begins with the first row after one, or after a gap; one
  /// that lacks a row does not count.
  void add(const std::vector<double>& t, const Eigen::VectorXd& values);

  struct Mean {
    double from = 0;  ///< s
    double value = 0;
  };
  const std::vector<Mean>& means() const { return means_; }
  double seconds() const { return row_seconds_ * static_cast<double>(n_rows_); }

 private:
  double row_seconds_;
  Eigen::Index n_rows_;      ///< of a window
  double last_ = 0;          ///< s, time of the last row
  Eigen::Index n_seen_ = 0;  ///< rows of the window so far
  double from_ = 0, sum_ = 0;
  std::vector<Mean> means_;
};

/// Root of the mean square of all means; 0 without any.
double rms_of(const std::vector<WindowSeries::Mean>& means);
/// sd of the means as if a few contacts were none: 1.4826 times the median of their magnitudes
/// (Rousseeuw & Croux 1993); 0 without any.
double robust_sd_of(const std::vector<WindowSeries::Mean>& means);

}  // namespace cablefit
