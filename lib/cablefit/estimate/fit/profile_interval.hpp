// The interval of a quantity under bounds and constraints, by its profile likelihood. The
// covariance does not include inequalities and says little there (Venzon & Moolgavkar 1988; Raue et
// al. 2009, Bioinformatics 25:1923).
#pragma once

#include <Eigen/Core>

#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// All v for which min |a x - b|^2 over g x >= 0, combination x = v exceeds the minimum without
/// that condition by no more than `threshold`. The profile is convex in v, so this is an interval;
/// it ends where the inequalities end if that comes first, and is one-sided at a bound that way.
/// With threshold t^2 variance it covers at least as often as the two-sided interval of a free
/// quantity (Self & Liang 1987: at a bound half of the statistic's mass is at 0). a: m x p,
/// g: any number of rows x p, as constrained_least_squares() takes them. The combination must be
/// determined by `a`; ends are exact to 1e-6 of sqrt(threshold) in its sd.
ProfileInterval profile_interval(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                 const Eigen::MatrixXd& g, const Eigen::RowVectorXd& combination,
                                 double threshold);

/// 95 % intervals of the parameters of a solution that bounds or constraints hold, for
/// LinearSolution::profile; empty where none does. The threshold is t^2 times the robust variance
/// (the white one unless `robust`) that the parameter has without them, in units of its (W'W)^-1.
/// NaN: not determined.
std::vector<ProfileInterval> profile_intervals(const RowStatistics& rows,
                                               const LinearProblem& problem,
                                               const LinearSolution& solution, bool robust);

}  // namespace cablefit
