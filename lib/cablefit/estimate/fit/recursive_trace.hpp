// Recursive least squares (R-LSA, [43] of Fichera & Grossard 2017) in square-root information form
// (Bierman 1977, ch. V): rows are added one after the other by QR, and the rows read so far
// are solved with the equalities of the direct fit (D-LSA), whose estimate is reached at the end.
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
};
struct RecursiveTrace {
  std::vector<std::string> names, preloads, units;  ///< per parameter; preload "all": shared
  std::vector<TracePoint> points;
};

/// The rows read so far: the triangular factor of [W y], weighted.
class RecursiveInformation {
 public:
  /// `equalities`: rows * x = 0, as in the direct fit; no rows: none.
  RecursiveInformation(const std::vector<std::string>& names, Eigen::MatrixXd equalities);

  /// Rows of an equation with the columns, the response and the weight of `block`.
  void add(const JointBlock& block, const Eigen::Ref<const Eigen::MatrixXd>& rows);

  TracePoint point(const std::string& record) const;

 private:
  RowStatistics seen_;
  JointProblem problem_;
};

/// Scales every parameter's band to end at the sd of the direct fit; on the way it keeps its ratio
/// to that of the rows seen so far. What a bound holds has no band, what is not identifiable stays
/// empty. `estimates`: as many as parameters, or more.
void end_at(std::span<const Estimate> estimates, RecursiveTrace& trace);

/// A figure per parameter: the estimate with its band of +-2 sd, and where it ends.
std::vector<Figure> trace_figures(const RecursiveTrace& trace);

}  // namespace cablefit
