// Recursive least squares (R-LSA, [43] of Fichera & Grossard 2017) in square-root information form
// (Bierman 1977, ch. V). Rows are added one after the other by QR. The rows read so far are solved
// with the equalities of the direct fit (D-LSA), so the last estimate is that of the direct fit.
// With a forgetting factor lambda < 1 a row has the weight lambda^age (Ljung & Soderstrom 1983,
// 2.6). The memory is 1/(1 - lambda) samples.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/estimate/fit/joint_least_squares.hpp"
#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// The linear parameters after n_rows rows.
struct TracePoint {
  std::size_t n_rows = 0;         ///< of all equations
  std::string record;             ///< "low, blocked": source of the last row
  std::vector<double> value, sd;  ///< per parameter; NaN: not known yet
  double t = 0;                   ///< s, over all logs; 0 throughout: not known
};

/// How each row updates an estimate, and how old rows lose weight.
struct OnlineRule {
  std::string method = "recursive";  ///< "recursive", "gradient"
  double forgetting = 1;  ///< lambda: weight of a row after one sample; 1: forgets nothing
  double memory = 0;      ///< s; 1/(1 - lambda) samples; 0: all
  double step = 0;        ///< of the gradient, in (0, 2); 0: recursive
  double slowest = 0;     ///< s, of the gradient: time constant of its slowest direction
};

struct RecursiveTrace {
  std::vector<std::string> names, preloads, units;  ///< per parameter; preload "all": shared
  std::vector<TracePoint> points;
  OnlineRule rule = {};
};

/// lambda for a memory of this many samples: 1 - 1/samples; samples >= 1.
double forgetting_factor(double memory_samples);
/// Number of rows of equal weight that give a mean with the same sd: (1 + lambda)/(1 - lambda), in
/// the long run and for white noise.
double equivalent_samples(double forgetting);

/// The rows read so far: the triangular factor of [W y], weighted.
class RecursiveInformation {
 public:
  /// `equalities`: rows * x = 0, as in the direct fit; no rows: none.
  RecursiveInformation(const std::vector<std::string>& names, Eigen::MatrixXd equalities);

  /// Rows of an equation with the columns, the response and the weight of `block`.
  void add(const JointBlock& block, const Eigen::Ref<const Eigen::MatrixXd>& rows);
  /// Rows with weights of their own, on top of the weight of the block.
  void add(const JointBlock& block, const Eigen::Ref<const Eigen::MatrixXd>& rows,
           const Eigen::Ref<const Eigen::VectorXd>& weights);
  /// Multiplies the weight of all rows read so far by `factor`.
  void forget(double factor);

  /// Values, and sd for white noise of variance 1/weight. For rows with different weights L the
  /// covariance is (W'LW)^-1 W'L^2 W (W'LW)^-1, so that old rows do not count as more certain than
  /// they are.
  TracePoint point(const std::string& record) const;

 private:
  RowStatistics seen_;
  RowStatistics squared_;  ///< the same with the squares of the weights, for the sd
  bool forgets_ = false;
  JointProblem problem_;

  Eigen::VectorXd variances(const JointSolution& s) const;
};

/// Scales the band of every parameter to end at the sd of the direct fit. Before the end the band
/// keeps its ratio to that of the rows read so far. A parameter held by a bound has no band; one
/// that is not identifiable stays empty. `estimates`: as many as parameters, or more.
void end_at(std::span<const Estimate> estimates, RecursiveTrace& trace);

/// Scales bands without fixing their end: every band times the ratio of the direct fit's sd to its
/// white-noise sd. Before scaling, a band is white-noise.
void scale_bands(std::span<const Estimate> estimates, RecursiveTrace& trace);

/// Parameter `k` at the end of a trace; NaN where it is not known.
struct OnlineEnd {
  double value = 0, sd = 0;
  double difference = 0;  ///< value - direct, in sd
};
OnlineEnd online_end(const RecursiveTrace& trace, std::size_t k, const Estimate& direct);

/// A figure per parameter: the estimate with its band of +-2 sd, and the direct estimate at its
/// end.
std::vector<Figure> trace_figures(const RecursiveTrace& trace);
/// As above, for several traces of the same parameters. `direct`: the estimates from all rows.
std::vector<Figure> trace_figures(std::span<const RecursiveTrace> traces,
                                  std::span<const Estimate> direct);

}  // namespace cablefit
