// Parallel decimation: every column of an equation, regressors and torque alike, through one and
// the same zero-phase FIR, then every M-th row (Gautier 1997).
#pragma once

#include <Eigen/Core>

namespace cablefit {

class Decimation {
 public:
  /// Hamming-windowed sinc of 20 M + 1 taps, -6 dB at the new Nyquist frequency, sum of taps 1 (the
  /// design of SciPy's decimate(ftype="fir")). M = 1 does nothing.
  explicit Decimation(int factor);

  int factor() const { return factor_; }
  /// Rows on either side that an output row depends on: 10 M, 0 for M = 1.
  Eigen::Index half_width() const { return factor_ == 1 ? 0 : 10 * factor_; }

  /// Output row for the input row `centre`. Taps that fall outside [first, last) are left out and
  /// the others scaled up alike, so that the ends of a log keep parallel columns.
  void apply(const Eigen::Ref<const Eigen::MatrixXd>& columns, Eigen::Index centre,
             Eigen::Index first, Eigen::Index last, Eigen::Ref<Eigen::RowVectorXd> out) const;

 private:
  int factor_;
  Eigen::VectorXd taps_;
};

}  // namespace cablefit
