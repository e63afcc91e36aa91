// Parallel decimation: one zero-phase FIR filters every column of an equation, regressors and
// torque alike. Then every M-th row is kept (Gautier 1997).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace cablefit {

class Decimation {
 public:
  /// Hamming-windowed sinc of 2 lobes M + 1 taps, -6 dB at the new Nyquist frequency, sum of taps 1
  /// (10 lobes: the design of SciPy's decimate(ftype="fir")). M = 1 does nothing.
  explicit Decimation(int factor, int lobes = 10);

  int factor() const { return factor_; }
  /// Rows on either side that an output row depends on: lobes M, 0 for M = 1. Averaging adds one
  /// row.
  Eigen::Index half_width() const { return factor_ == 1 ? 0 : lobes_ * factor_; }

  /// One output row per input row in `centres`, centres x columns. Taps outside [first, last) are
  /// left out and the others scaled up, alike in all columns, so that the columns stay parallel at
  /// the ends of a log.
  ///
  /// Columns that are `averaged` are also averaged over the triangle (1, 10, 1)/12 of +-1 row. A
  /// second difference IS the mean acceleration under that triangle (Numerov), so every other
  /// column of an equation must be averaged alike. Without it J_motor is 1.8 % too large at 1 kHz
  /// on the paper's rig, through K T^2/(12 J). Empty: no column is averaged. Averages reach one row
  /// beyond [first, last).
  Eigen::MatrixXd apply(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                        std::span<const Eigen::Index> centres, Eigen::Index first,
                        Eigen::Index last, const std::vector<bool>& averaged) const;

 private:
  void apply_to(const Eigen::Ref<const Eigen::MatrixXd>& columns,
                const std::vector<Eigen::Index>& which, std::span<const Eigen::Index> centres,
                Eigen::Index first, Eigen::Index last, bool averaged, Eigen::MatrixXd& out) const;

  int factor_, lobes_;
  Eigen::VectorXd taps_;
};

}  // namespace cablefit
