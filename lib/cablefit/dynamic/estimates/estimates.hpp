// From the solution of one equation to parameters with sd and intervals.
#pragma once

#include <span>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/dynamic/rows/dynamic_columns.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// Appends the parameters and warnings of an equation, or of several with shared parameters, to
/// `fit`. The covariance of stage 1 is propagated (Murphy & Topel 1985): x depends on the elastic
/// coefficients by (W'W)^-1 W'Z, so their robust covariance adds to that of x. `which`: the elastic
/// fit's place among the columns.
void add_estimates(const RowStatistics& rows, const DynamicColumns& columns,
                   const LinearSolution& solution, const ElasticFit* stage1, std::size_t which,
                   bool robust, DynamicFit& fit);

/// Change of the parameters when one of the rows' columns from `first` on is added to the response:
/// p x n. `rows`: those that `solution` was fitted to.
Eigen::MatrixXd moved_by(const RowStatistics& rows, const LinearSolution& solution,
                         Eigen::Index first, Eigen::Index n);

/// An inertia given by the rig file, taken as exact.
Estimate given_estimate(const DynamicParameter& parameter);

/// Removes the numbers of an estimate and records the reason.
void refuse(Estimate& e, const std::string& why);

/// Refuses the linear parameters of an effect beyond (31) when a nonlinear one of it is not
/// determined: an amplitude has no meaning without it.
void refuse_dependent(const EffectsPerJoint& effects, std::vector<Estimate>& parameters);

/// Why the motion of these rows does not separate the inertia of column `k` from a torque that
/// depends on position, for any estimator; empty when it does.
std::string inertia_alias(const RowStatistics& rows, const DynamicColumns& columns, Eigen::Index k);

/// The kind of sd of these parameters, and the reason: "HAC: residuals are correlated over 14 ms,
/// effective rows 812 of 12639". `row_seconds`: between rows.
std::string sd_reason(const RowStatistics& rows, const DynamicColumns& columns,
                      const LinearSolution& solution, double row_seconds);

/// Adds errors, weight and conditioning of one equation with these rows.
void add_errors(const RowStatistics& rows, const std::string& equation,
                const LinearSolution& solution, DynamicFit& fit);

}  // namespace cablefit
