// How much of what was measured a model explains, in words for plots and reports.
#pragma once

#include <cstddef>
#include <string>

namespace cablefit {

/// Share of the sum of squares that a residual leaves explained, in per cent, with as many digits
/// as the rest needs: "99.983 %". At least "0 %"; "-" where nothing was measured.
std::string explained_percent(double squares, double residual_squares);

/// Sums over measured and modelled values, added one by one.
class Explained {
 public:
  void add(double measured, double residual) {
    ++n_;
    sum_ += measured;
    squares_ += measured * measured;
    residual_squares_ += residual * residual;
  }
  /// Of the squares of a torque, whose zero means something.
  std::string of_squares() const { return explained_percent(squares_, residual_squares_); }
  /// Of the squares about the mean, for a position, whose zero is arbitrary.
  std::string about_mean() const;

 private:
  std::size_t n_ = 0;
  double sum_ = 0, squares_ = 0, residual_squares_ = 0;
};

}  // namespace cablefit
