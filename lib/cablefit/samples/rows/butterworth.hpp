// Zero-phase Butterworth low-pass, applied to every signal alike ("parallel filtering", Gautier
// 1997). It changes both sides of an equation in the same way, so the equation still holds.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace cablefit {

/// One second-order section, a0 = 1: y = b0 x + b1 x1 + b2 x2 - a1 y1 - a2 y2.
struct Biquad {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;
};

class Butterworth {
 public:
  /// Order 1..10, cut-off (-3 dB of one pass) in Hz below rate/2, by the bilinear transform with
  /// prewarping. Forward and backward passes together give zero phase and -6 dB at the cut-off.
  Butterworth(int order, double cutoff, double rate);

  /// Filters every column in place, forward then backward. Each pass starts in the steady state of
  /// its first value. `odd_start`/`odd_end`: the data begin/end here, so odd reflection extends
  /// them first (as in MATLAB's and SciPy's filtfilt). Otherwise the data continue beyond the cut.
  void apply(Eigen::Ref<Eigen::MatrixXd> columns, bool odd_start, bool odd_end) const;

  /// Rows after which a start-up transient is below 1e-10.
  Eigen::Index settling_rows() const { return settling_rows_; }
  const std::vector<Biquad>& sections() const { return sections_; }

 private:
  std::vector<Biquad> sections_;
  Eigen::Index settling_rows_ = 0;
};

}  // namespace cablefit
