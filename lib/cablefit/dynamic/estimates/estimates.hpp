// From the solution of one equation to parameters with robust sd.
#pragma once

#include <span>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// Appends the parameters and warnings of an equation, or of several with shared parameters, to
/// `fit`. The covariance of stage
/// 1 is carried through (Murphy & Topel 1985): x depends on the elastic coefficients by (W'W)^-1
/// W'Z, so their robust covariance adds to that of x. `which`: the elastic fit's place among the
/// columns.
void add_estimates(const RowStatistics& rows, const DynamicColumns& columns,
                   const LinearSolution& solution, const ElasticFit* stage1, std::size_t which,
                   bool linear_motion, bool robust, DynamicFit& fit);

/// By how much the parameters move when one of the rows' columns from `first` on is added to
/// the response: p x n. `rows`: those that `solution` was fitted to.
Eigen::MatrixXd moved_by(const RowStatistics& rows, const LinearSolution& solution,
                         Eigen::Index first, Eigen::Index n);

/// An inertia that the rig file gives: exact.
Estimate given_estimate(const DynamicParameter& parameter, bool linear_motion);

/// Takes the numbers from an estimate and says why.
void refuse(Estimate& e, const std::string& why);

/// An amplitude means nothing without its nonlinear parameters: refuses the linear parameters of
/// effects beyond (31) of which a nonlinear one is not determined.
void refuse_dependent(std::span<const EffectInstance> effects, std::vector<Estimate>& parameters);

/// Why these rows cannot separate the inertia of column `k` from a torque that depends on
/// position, whatever the estimator; empty when it can.
std::string inertia_alias(const RowStatistics& rows, const DynamicColumns& columns, Eigen::Index k,
                          bool linear_motion);

/// Which sd the parameters of these rows have, and why: "HAC: residuals are correlated over 14 ms,
/// effective rows 812 of 12639". `row_seconds`: between rows.
std::string sd_reason(const RowStatistics& rows, const DynamicColumns& columns,
                      const LinearSolution& solution, double row_seconds);

/// Errors, weight and conditioning of one equation with these rows.
void add_errors(const RowStatistics& rows, const std::string& equation,
                const LinearSolution& solution, DynamicFit& fit);

}  // namespace cablefit
