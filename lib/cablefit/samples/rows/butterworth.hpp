// Zero-phase Butterworth low-pass, applied alike to every signal ("parallel filtering", Gautier
// 1997): what the filter does to one side of an equation it does to the other.
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

  /// Filters every column in place, forward then backward, starting each pass in the steady state
  /// of its first value. `odd_start`/`odd_end`: the data really begin/end here, so they are
  /// continued by odd reflection first (as MATLAB's and SciPy's filtfilt do) rather than cut.
  void apply(Eigen::Ref<Eigen::MatrixXd> columns, bool odd_start, bool odd_end) const;

  /// Rows after which a start-up transient has fallen below 1e-10.
  Eigen::Index settling_rows() const { return settling_rows_; }
  const std::vector<Biquad>& sections() const { return sections_; }

 private:
  std::vector<Biquad> sections_;
  Eigen::Index settling_rows_ = 0;
};

}  // namespace cablefit
