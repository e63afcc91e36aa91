// Recursive least squares (R-LSA, [43] of Fichera & Grossard 2017) in square-root information form
// (Bierman 1977, ch. V): rows are added one after the other by QR, and the rows read so far
// are solved with the equalities of the direct fit (D-LSA), whose estimate is reached at the end.
// With a forgetting factor lambda < 1 a row counts lambda^age (Ljung & Soderstrom 1983, 2.6): the
// memory is 1/(1 - lambda) samples.
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

/// The linear parameters after so many rows.
struct TracePoint {
  std::size_t n_rows = 0;         ///< of all equations
  std::string record;             ///< "low, blocked": where the last of them comes from
  std::vector<double> value, sd;  ///< per parameter; NaN: not known yet
  double t = 0;                   ///< s, over all logs; 0 throughout: not known
};

/// How an estimate is updated with every row, and what it forgets.
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

/// lambda with a memory of so many samples: 1 - 1/samples; samples >= 1.
double forgetting_factor(double memory_samples);
/// Rows of one weight that give a mean as certain, (1 + lambda)/(1 - lambda), in the long run and
/// for white noise.
double equivalent_samples(double forgetting);

/// The rows read so far: the triangular factor of [W y], weighted.
class RecursiveInformation {
 public:
  /// `equalities`: rows * x = 0, as in the direct fit; no rows: none.
  RecursiveInformation(const std::vector<std::string>& names, Eigen::MatrixXd equalities);

  /// Rows of an equation with the columns, the response and the weight of `block`.
  void add(const JointBlock& block, const Eigen::Ref<const Eigen::MatrixXd>& rows);
  /// Rows that count `weights` each, besides the weight of the block.
  void add(const JointBlock& block, const Eigen::Ref<const Eigen::MatrixXd>& rows,
           const Eigen::Ref<const Eigen::VectorXd>& weights);
  /// The rows read so far count `factor` times what they did.
  void forget(double factor);

  /// Values, and sd for white noise of variance 1/weight. Where rows count differently:
  /// (W'LW)^-1 W'L^2 W (W'LW)^-1, L the weights, so that old rows add no certainty they have not.
  TracePoint point(const std::string& record) const;

 private:
  RowStatistics seen_;
  RowStatistics squared_;  ///< the same with the squares of the weights, for the sd
  bool forgets_ = false;
  JointProblem problem_;

  Eigen::VectorXd variances(const JointSolution& s) const;
};

/// Scales every parameter's band to end at the sd of the direct fit; on the way it keeps its ratio
/// to that of the rows seen so far. What a bound holds has no band, what is not identifiable stays
/// empty. `estimates`: as many as parameters, or more.
void end_at(std::span<const Estimate> estimates, RecursiveTrace& trace);

/// The same without that end: every band times the ratio of the direct fit's sd to its white-noise
/// one, which the band has.
void scale_bands(std::span<const Estimate> estimates, RecursiveTrace& trace);

/// Parameter `k` at the end of a trace; NaN where it is not known.
struct OnlineEnd {
  double value = 0, sd = 0;
  double difference = 0;  ///< value - direct, in sd
};
OnlineEnd online_end(const RecursiveTrace& trace, std::size_t k, const Estimate& direct);

/// A figure per parameter: the estimate with its band of +-2 sd, and where it ends.
std::vector<Figure> trace_figures(const RecursiveTrace& trace);
/// The same with several traces of the same parameters, `direct` the answer from all rows.
std::vector<Figure> trace_figures(std::span<const RecursiveTrace> traces,
                                  std::span<const Estimate> direct);

}  // namespace cablefit
