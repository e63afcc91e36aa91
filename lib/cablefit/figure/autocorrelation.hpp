// How much a residual still knows of itself some rows later: white noise knows nothing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

inline constexpr Eigen::Index kMostLags = 60;

class Autocorrelation {
 public:
  Autocorrelation();

  /// Consecutive rows: `numbers` their places on the time grid, growing; `values` n rows. Pairs
  /// across a hole have the lag that their places say.
  void add(const std::vector<Eigen::Index>& numbers,
           const Eigen::Ref<const Eigen::VectorXd>& values);

  /// rho(lag) against the lag in rows, from 1; lags without pairs are left out.
  void draw(Trace& trace) const;
  /// 1.96 / sqrt(n): 95 % of the lags of white noise stay within plus and minus this.
  double white_band() const;

 private:
  /// Drops all but what later rows can still pair with.
  void keep_tail();

  // The last rows and those just added on their grid; where there is none, value and mark are 0.
  std::vector<double> values_, marks_;
  Eigen::Index first_number_ = 0;
  std::vector<double> products_, pairs_;
  double squares_ = 0, n_ = 0;
};

}  // namespace cablefit
